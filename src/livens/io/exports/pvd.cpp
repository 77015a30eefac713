// SPDX-License-Identifier: BSD-3-Clause
// ParaView collections: surfaces of the bodies, a file an instant, and a list of these. [VTK file formats]
// Points are in world coordinates, so each instant is a whole picture; velocities of points are those of the
// rigid body, v + w x arm (docs/results.md).
#include <algorithm>
#include <cmath>
#include <span>
#include <system_error>

#include "livens/base/text.h"
#include "livens/diagnostics/sample.h"
#include "livens/io/exports/formats.h"

namespace livens::inline io_internal {

namespace {

namespace fs = std::filesystem;

std::string xml_text(std::string_view text)
{
    std::string out;
    for (const char c : text)
        out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
    return out;
}

/// The text of the arrays, and their numbers, which stand behind all text.
class Appended {
public:
    template <class Number>
    void add(const char* type, const char* name, int n_components, std::span<const Number> values)
    {
        xml += std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
               std::to_string(n_components) + "\" format=\"appended\" offset=\"" +
               std::to_string(bytes.size()) + "\"/>\n";
        put(bytes, static_cast<std::uint64_t>(values.size() * sizeof(Number)));
        for (const Number x : values) put(bytes, x);
    }

    std::string xml, bytes;
};

/// Bodies as they stand at one instant.
struct Picture {
    std::vector<float> points, velocities;
    std::vector<int> corners, offsets, bodies;

    void add(int body, const Surface& surface, const BodySample& s)
    {
        const int first = static_cast<int>(points.size() / 3);
        const bool is_point = std::isnan(s.quaternion[0]);
        const Matrix3 triad = is_point ? identity<3>() : directors_from_quaternion(s.quaternion);
        for (const Vector3& p : surface.points) {
            const Vector3 arm = triad * p;
            const Vector3 velocity = is_point ? s.velocity : s.velocity + cross(s.angular_velocity, arm);
            for (int i = 0; i < 3; ++i) {
                points.push_back(static_cast<float>(s.position[i] + arm[i]));
                velocities.push_back(static_cast<float>(velocity[i]));
            }
        }
        for (const auto& triangle : surface.triangles) {
            for (const int c : triangle) corners.push_back(first + c);
            offsets.push_back(static_cast<int>(corners.size()));
            bodies.push_back(body);
        }
    }
};

/// Names as VTK has texts: the numbers of their bytes, zero behind each.
std::string names_of(const Run& run)
{
    std::string xml = "<Array type=\"String\" Name=\"body_name\" NumberOfTuples=\"" +
                      std::to_string(run.n_told_bodies()) + "\" format=\"ascii\">\n";
    for (const std::string& name : run.told_bodies()) {
        for (const char c : name) xml += std::to_string(static_cast<unsigned char>(c)) + " ";
        xml += "0\n";
    }
    return xml + "</Array>\n";
}

std::string file_of(const Picture& p, const std::string& field)
{
    const auto numbers = [](const auto& list) { return std::span(list.data(), list.size()); };
    Appended data;
    data.xml = "<PointData Vectors=\"velocity\">\n";
    data.add("Float32", "velocity", 3, numbers(p.velocities));
    data.xml += "</PointData>\n<CellData Scalars=\"body\">\n";
    data.add("Int32", "body", 1, numbers(p.bodies));
    data.xml += "</CellData>\n<Points>\n";
    data.add("Float32", "Points", 3, numbers(p.points));
    data.xml += "</Points>\n<Polys>\n";
    data.add("Int32", "connectivity", 1, numbers(p.corners));
    data.add("Int32", "offsets", 1, numbers(p.offsets));
    return std::string(vtp_head) + "<PolyData>\n<FieldData>\n" + field +
           "</FieldData>\n<Piece NumberOfPoints=\"" + std::to_string(p.points.size() / 3) +
           "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
           std::to_string(p.offsets.size()) + "\">\n" + data.xml +
           "</Polys>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_" + data.bytes +
           "\n</AppendedData>\n</VTKFile>\n";
}

/// From the list on.
fs::path piece_of(const fs::path& name, std::size_t n)
{
    const std::string digits = std::to_string(n);
    const std::size_t zeros = digits.size() < 6 ? 6 - digits.size() : 0;
    return name / (name.string() + "_" + std::string(zeros, '0') + digits + ".vtp");
}

/// Nothing is written if one of the files in the folder is somebody else's.
void check_pieces(const fs::path& folder, const fs::path& name, std::size_t n_pieces)
{
    const auto is_own = [](std::string_view head) { return head.starts_with(vtp_head); };
    for (std::size_t i = 0; i < n_pieces; ++i)
        if (const fs::path piece = folder / piece_of(name, i); is_occupied(piece, is_own))
            throw IoError("cannot write '" + piece.string() +
                          "': there is a file that livens did not write; give the list another name, or "
                          "say that it may be replaced (--force)");
}

}   // namespace

/// The folder has the name of the list without its ending. The list comes last: it names no file that is not
/// there.
void write_pvd(const fs::path& file, const ExportInput& input)
{
    const Run& run = input.run;
    std::vector<Surface> surfaces;
    for (const std::vector<Drawn>& drawn : drawn_of(input.scenario)) surfaces.push_back(united(drawn));
    const fs::path name = file.stem(), folder = file.parent_path() / name;
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw IoError("cannot write '" + folder.string() + "': " + error.message());
    const std::string names = names_of(run);
    const std::vector<double> times = reached_times(run);
    // All names are looked at before the first file is written: a refusal leaves nothing behind.
    if (!input.force) check_pieces(file.parent_path(), name, times.size());
    std::string list = std::string(pvd_head) + "<Collection>\n";
    std::size_t n = 0;
    for (const double t : times) {
        Picture picture;
        const std::vector<BodySample> bodies = sample_bodies(input.scenario.model, run.motion, t);
        for (std::size_t b = 0; b < bodies.size(); ++b)
            picture.add(static_cast<int>(b), surfaces[b], bodies[b]);
        BodySample still{};
        still.quaternion = {1, 0, 0, 0};
        picture.add(world, surfaces.back(), still);
        const fs::path piece = piece_of(name, n++);
        const std::string time = "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
                                 "format=\"ascii\">" +
                                 to_text(t) + "</DataArray>\n";
        replace_file(file.parent_path() / piece, file_of(picture, time + names));
        list += "<DataSet timestep=\"" + to_text(t) + "\" group=\"\" part=\"0\" file=\"" +
                xml_text(piece.generic_string()) + "\"/>\n";
    }
    replace_file(file, list + "</Collection>\n</VTKFile>\n");
}

}   // namespace livens::inline io_internal
