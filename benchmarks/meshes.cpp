// SPDX-License-Identifier: BSD-3-Clause
// What a mesh of a million triangles takes, next to reading the bytes of its file: `meshes [n]`, n times 1000
// triangles. Reading the bytes is one std::ifstream::read of the whole file, which the system still holds in
// memory, into memory that is new.
#include <fcntl.h>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <numbers>
#include <string>

#include "livens/geometry/moments.h"
#include "livens/geometry/soundness.h"

namespace {

double time_of(clockid_t clock)
{
    timespec t{};
    clock_gettime(clock, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// The fastest of five, each after what is not timed; of the processors all threads together.
double seconds(
    const std::function<void()>& work, const std::function<void()>& before = [] {},
    clockid_t clock = CLOCK_MONOTONIC)
{
    double least = HUGE_VAL;
    for (int k = 0; k < 5; ++k) {
        before();
        const double begin = time_of(clock);
        work();
        least = std::min(least, time_of(clock) - begin);
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

/// Gmsh's MSH 4.1, the surface alone.
std::string msh(int n)
{
    const std::int64_t n_points = std::int64_t{n} * n, n_faces = 2 * n_points;
    std::string bytes = "$MeshFormat\n4.1 1 8\n";
    put(bytes, std::int32_t{1});
    const auto begin = [&](const char* name, std::int64_t count, std::int32_t type) {
        bytes += name;
        for (const std::int64_t x : {std::int64_t{1}, count, std::int64_t{1}, count}) put(bytes, x);
        for (const std::int32_t x : {2, 1, type}) put(bytes, x);
        put(bytes, count);
    };
    begin("\n$EndMeshFormat\n$Nodes\n", n_points, 0);
    for (std::int64_t k = 1; k <= n_points; ++k) put(bytes, k);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < 3; ++k) put(bytes, point(i, j, n)[k]);
    begin("\n$EndNodes\n$Elements\n", n_faces, 2);
    std::int64_t face = 0;
    for_faces(n, [&](int a, int b, int c, int d, int e, int f) {
        put(bytes, ++face);
        for (const auto& [i, j] : {std::pair(a, b), {c, d}, {e, f}})
            put(bytes, std::int64_t{1} + (i % n) * n + j % n);
    });
    return bytes + "\n$EndElements\n";
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
    const auto all_work = [&] {
        const livens::Mesh again = livens::read_mesh_file(file);
        is_sound = livens::faults_of(again).empty() && is_sound;
        livens::moments(again);
    };
    const double of_processors = seconds(
                                     all_work, [] {}, CLOCK_PROCESS_CPUTIME_ID) /
                                 seconds(
                                     read, [] {}, CLOCK_PROCESS_CPUTIME_ID);
    std::printf(
        "%s: %lld triangles, %.0f MB: mesh %.3f s, faults %.3f s, moments %.3f s; volume off by "
        "%.1e\n    bytes from memory %.4f s: %.1f times; from the disk %.4f s: %.1f times; processors %.1f "
        "times\n",
        file.filename().c_str(), static_cast<long long>(mesh.n_elements(2)),
        1e-6 * static_cast<double>(bytes.size()), of_mesh, of_faults, of_moments, error, of_bytes,
        all / of_bytes, of_disk, (all + of_disk - of_bytes) / of_disk, of_processors);
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
    good = measure(folder / "livens-torus.msh", msh(n)) && good;
    rusage use{};
    getrusage(RUSAGE_SELF, &use);
    std::printf("largest memory: %.0f MB, the file's bytes made here included\n",
                1e-3 * static_cast<double>(use.ru_maxrss));
    return good ? 0 : 1;
}
