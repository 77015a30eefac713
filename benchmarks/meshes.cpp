// SPDX-License-Identifier: BSD-3-Clause
// What a mesh of a million triangles takes, next to reading the bytes of its file: `meshes [n]`, n times 1000
// triangles.
#include <fcntl.h>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <numbers>
#include <string>

#include "livens/geometry/moments.h"
#include "livens/geometry/soundness.h"

namespace {

using Clock = std::chrono::steady_clock;

/// The fastest of five, each after what is not timed.
double seconds(
    const std::function<void()>& work, const std::function<void()>& before = [] {})
{
    double least = HUGE_VAL;
    for (int k = 0; k < 5; ++k) {
        before();
        const auto begin = Clock::now();
        work();
        least = std::min(least, std::chrono::duration<double>(Clock::now() - begin).count());
    }
    return least;
}

template <class T>
void put(std::string& bytes, T value)
{
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// A torus with radii 2 and 0.5, n x n points.
livens::Vector3 point(int i, int j, int n)
{
    const double a = 2 * std::numbers::pi * (i % n) / n, b = 2 * std::numbers::pi * (j % n) / n;
    const double r = 2 + 0.5 * std::cos(b);
    return {r * std::cos(a), r * std::sin(a), 0.5 * std::sin(b)};
}

template <class Face>
void for_faces(int n, Face face)
{
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            face(i, j, i + 1, j, i + 1, j + 1);
            face(i, j, i + 1, j + 1, i, j + 1);
        }
}

std::string stl(int n)
{
    std::string bytes(80, ' ');
    put(bytes, static_cast<std::uint32_t>(2 * n * n));
    for_faces(n, [&](int a, int b, int c, int d, int e, int f) {
        for (int i = 0; i < 3; ++i) put(bytes, 0.0f);
        for (const livens::Vector3& p : {point(a, b, n), point(c, d, n), point(e, f, n)})
            for (int i = 0; i < 3; ++i) put(bytes, static_cast<float>(p[i]));
        put(bytes, std::uint16_t{0});
    });
    return bytes;
}

std::string ply(int n)
{
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(n * n) +
                        "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                        std::to_string(2 * n * n) + "\nproperty list uchar int vertex_indices\nend_header\n";
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < 3; ++k) put(bytes, point(i, j, n)[k]);
    for_faces(n, [&](int a, int b, int c, int d, int e, int f) {
        put(bytes, std::uint8_t{3});
        for (const auto& [i, j] : {std::pair(a, b), {c, d}, {e, f}}) put(bytes, (i % n) * n + j % n);
    });
    return bytes;
}

/// What the system keeps of a file in memory is given back, so that it is read from the disk.
void forget(const std::filesystem::path& file)
{
    const int fd = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (fd < 0) return;
    fdatasync(fd);
    posix_fadvise(fd, 0, 0, POSIX_FADV_DONTNEED);
    close(fd);
}

bool measure(const std::filesystem::path& file, const std::string& bytes)
{
    std::ofstream(file, std::ios::binary) << bytes;
    const auto read = [&] {
        const auto buffer = std::make_unique_for_overwrite<char[]>(bytes.size());
        std::ifstream(file, std::ios::binary).read(buffer.get(), static_cast<std::streamsize>(bytes.size()));
    };
    const double of_bytes = seconds(read), of_disk = seconds(read, [&] { forget(file); });
    livens::Mesh mesh;
    livens::Moments m;
    bool is_sound = false;
    const double of_mesh = seconds([&] { mesh = livens::read_mesh_file(file); });
    const double of_faults = seconds([&] { is_sound = livens::faults_of(mesh).empty(); });
    const double of_moments = seconds([&] { m = livens::moments(mesh); });
    const double exact = 2 * std::numbers::pi * std::numbers::pi * 2 * 0.25,
                 error = std::abs(m.volume / exact - 1);
    const double all = of_mesh + of_faults + of_moments;
    std::printf("%s: %lld triangles, %.0f MB: mesh %.3f s, faults %.3f s, moments %.3f s; volume off by "
                "%.1e\n    bytes from memory %.4f s: %.1f times; from the disk %.4f s: %.1f times\n",
                file.filename().c_str(), static_cast<long long>(mesh.n_elements(2)),
                1e-6 * static_cast<double>(bytes.size()), of_mesh, of_faults, of_moments, error, of_bytes,
                all / of_bytes, of_disk, (all + of_disk - of_bytes) / of_disk);
    std::filesystem::remove(file);
    return is_sound && error * static_cast<double>(mesh.n_elements(2)) < 40;   // order 2
}

}   // namespace

int main(int argc, char** argv)
{
    mallopt(M_MMAP_THRESHOLD,
            1 << 20);   // memory is new each time, as it is for a program that reads one file
    const int thousands = argc > 1 ? std::atoi(argv[1]) : 1000,
              n = static_cast<int>(std::sqrt(500.0 * thousands));
    if (n < 3) return 2;
    const std::filesystem::path folder = std::filesystem::temp_directory_path();
    bool good = measure(folder / "livens-torus.stl", stl(n));
    good = measure(folder / "livens-torus.ply", ply(n)) && good;
    rusage use{};
    getrusage(RUSAGE_SELF, &use);
    std::printf("largest memory: %.0f MB, the file's bytes made here included\n",
                1e-3 * static_cast<double>(use.ru_maxrss));
    return good ? 0 : 1;
}
