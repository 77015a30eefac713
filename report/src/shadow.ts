// SPDX-License-Identifier: BSD-3-Clause
// A soft shadow on the ground, straight below what casts it: what covers the ground, seen from above in a small picture,
// which is blurred.
import {
  Color,
  DoubleSide,
  Mesh,
  MeshBasicMaterial,
  OrthographicCamera,
  PlaneGeometry,
  Scene,
  ShaderMaterial,
  Vector2,
  WebGLRenderTarget,
  type WebGLRenderer,
} from "three";
import type { Plane } from "./ground";
import { theme } from "./theme";

const size = 320; // px of the picture
const radius = 1.6; // px between what is mixed
export const casts = 1; // layer of what casts a shadow

const whole = "varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }";
const mixed = `varying vec2 at; uniform sampler2D seen; uniform vec2 step;
void main() {
  float sum = 0.0, all = 0.0;
  for (int k = -5; k <= 5; ++k) {
    float weight = exp(-0.08 * float(k * k));
    sum += weight * texture2D(seen, at + float(k) * step).a;
    all += weight;
  }
  gl_FragColor = vec4(0.0, 0.0, 0.0, sum / all);
}`;
const placed =
  "varying vec2 at; void main() { at = uv; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }";
const laid = `varying vec2 at; uniform sampler2D seen; uniform float dark; uniform vec3 tint;
void main() { gl_FragColor = vec4(tint, dark * texture2D(seen, at).a); }`;

export class Shadow {
  readonly object: Mesh;
  private readonly camera: OrthographicCamera;
  private readonly targets = [0, 1].map(() => new WebGLRenderTarget(size, size, { depthBuffer: true }));
  private readonly cast = new MeshBasicMaterial({ color: 0x000000, side: DoubleSide });
  private readonly mix = new ShaderMaterial({
    vertexShader: whole,
    fragmentShader: mixed,
    uniforms: { seen: { value: null }, step: { value: new Vector2() } },
    depthTest: false,
  });
  private readonly pass = new Scene();
  private readonly camera_of_pass = new OrthographicCamera(-1, 1, 1, -1, -1, 1);

  constructor({ x, y, up, middle, half }: Plane, reach: number) {
    const surface = new ShaderMaterial({
      vertexShader: placed,
      fragmentShader: laid,
      uniforms: {
        seen: { value: this.targets[0].texture },
        dark: { value: theme().shadow },
        tint: { value: new Color(theme().shade) },
      },
      transparent: true,
      depthWrite: false,
    });
    this.object = new Mesh(new PlaneGeometry(2 * half[0], 2 * half[1]), surface);
    this.object.matrixAutoUpdate = false;
    this.object.matrix.makeBasis(x, y, up).setPosition(middle);
    this.object.renderOrder = -1;
    // From above, its own axes along those of the plane.
    this.camera = new OrthographicCamera(-half[0], half[0], half[1], -half[1], 0, reach);
    this.camera.matrixAutoUpdate = false;
    this.camera.matrix.makeBasis(x, y, up).setPosition(middle.clone().addScaledVector(up, reach));
    this.camera.layers.set(casts);
    this.camera.updateMatrixWorld(true);
    this.pass.add(new Mesh(new PlaneGeometry(2, 2), this.mix));
  }

  /** Before everything else of a frame is drawn. */
  draw(renderer: WebGLRenderer, scene: Scene) {
    const [seen, other] = this.targets,
      { uniforms } = this.mix;
    scene.overrideMaterial = this.cast;
    renderer.setRenderTarget(seen);
    renderer.render(scene, this.camera);
    scene.overrideMaterial = null;
    for (const [from, to, way] of [
      [seen, other, [radius / size, 0]],
      [other, seen, [0, radius / size]],
    ] as const) {
      uniforms.seen.value = from.texture;
      uniforms.step.value.set(...way);
      renderer.setRenderTarget(to);
      renderer.render(this.pass, this.camera_of_pass);
    }
    renderer.setRenderTarget(null);
  }
}
