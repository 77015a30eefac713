#include "livens/io/results.h"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <limits>
#include <type_traits>

#include "livens/base/version.h"
#include "livens/io/detail/atomic_file.h"
#include "livens/io/detail/netcdf_file.h"
#include "livens/io/detail/results_digest.h"
#include "livens/io/detail/results_layout.h"

namespace livens {

namespace {

constexpr std::uintmax_t max_run_bytes = std::uintmax_t{1} << 40;

std::string text_dimension(const std::string& name) { return name + "_length"; }

/// Everything of a run goes into the file; empty lists and fields are left out.
class Writing {
public:
    explicit Writing(NetcdfWriter& file) : file_(file) {}

    void dimension(const std::string& name, std::size_t length) { file_.dimension(name, length); }

    /// Short texts are attributes, long ones variables: attributes have a limit.
    void text(const std::string& name, const std::string& value)
    {
        if (value.size() <= NetcdfWriter::max_attribute && name != "scenario" && name != "options") {
            file_.attribute(name, value);
        } else if (!value.empty()) {
            file_.dimension(text_dimension(name), value.size());
            file_.text_variable({name, {text_dimension(name)}, "1", "none", name}, value);
        }
    }

    void number(const std::string& name, bool value) { file_.attribute(name, value ? 1 : 0); }
    void number(const std::string& name, int value) { file_.attribute(name, value); }
    void number(const std::string& name, long value) { file_.attribute(name, static_cast<long long>(value)); }
    void number(const std::string& name, long long value) { file_.attribute(name, value); }
    void number(const std::string& name, double value) { file_.attribute(name, value); }
    void number(const std::string& name, SolveStatus value)
    {
        file_.attribute(name, static_cast<int>(of_solver(value)));
    }
    void status(const std::string& name, SolveStatus value) { text(name, to_string(value)); }

    /// One row of characters each, filled up with zeros.
    void names(VariableInfo info, const std::vector<std::string>& values)
    {
        if (values.empty()) return;
        std::size_t width = 1;
        for (const std::string& s : values) width = std::max(width, s.size());
        const std::string& over = info.dimensions.front();
        if (over == info.name && info.name.ends_with("note")) file_.dimension(over, values.size());
        file_.dimension(text_dimension(info.name), width);
        info.dimensions.push_back(text_dimension(info.name));
        std::string bytes(width * values.size(), '\0');
        for (std::size_t i = 0; i < values.size(); ++i) values[i].copy(bytes.data() + i * width, width);
        file_.text_variable(info, std::move(bytes));
    }

    void flags(const VariableInfo& info, const std::vector<bool>& values)
    {
        if (values.empty()) return;
        flags_.emplace_back(values.begin(), values.end());
        file_.variable(info, flags_.back());
    }

    template <class T>
    void list(const VariableInfo& info, const std::vector<T>& values)
    {
        if (values.empty()) return;
        if constexpr (is_matrix<T>)
            file_.variable(info, numbers(values));
        else
            file_.variable(info, std::span<const T>(values));
    }

    void field(VariableInfo info, const Field& field)
    {
        if (field.empty()) return;
        file_.dimension(info.dimensions.front(),
                        field.values.size() / static_cast<std::size_t>(field.n_values));
        info.int_attributes = {{"degree", field.degree}, {"continuous", field.continuous ? 1 : 0}};
        info.text_attributes.emplace_back("nodes", "Gauss-Lobatto points of each element, in ascending time");
        file_.variable(info, std::span<const double>(field.values));
    }

private:
    NetcdfWriter& file_;
    std::deque<std::vector<signed char>> flags_;
};

/// Everything of a run comes from the file; what is not there is empty.
class Reading {
public:
    explicit Reading(const NetcdfReader& file) : file_(file) {}

    void dimension(const std::string&, std::size_t) {}

    void text(const std::string& name, std::string& value)
    {
        if (file_.has_variable(name))
            value = file_.text({name, {text_dimension(name)}});
        else if (file_.has_attribute(name))
            value = file_.text_attribute(name);
    }

    void number(const std::string& name, bool& value) { value = file_.int_attribute(name) != 0; }
    void number(const std::string& name, long& value)
    {
        value = static_cast<long>(file_.int_attribute(name));
    }
    void number(const std::string& name, long long& value) { value = file_.int_attribute(name); }
    void number(const std::string& name, double& value) { value = file_.double_attribute(name); }
    void number(const std::string& name, int& value)
    {
        const long long n = file_.int_attribute(name);
        if (n < std::numeric_limits<int>::min() || n > std::numeric_limits<int>::max())
            throw IoError("attribute " + name + " is out of range");
        value = static_cast<int>(n);
    }
    void number(const std::string& name, SolveStatus& value)
    {
        int n = 0;
        number(name, n);
        if (n < 0 || n > static_cast<int>(SolveStatus::cancelled))
            throw IoError("attribute " + name + " is out of range");
        value = static_cast<SolveStatus>(n);
    }
    void status(const std::string& name, SolveStatus& value)
    {
        std::string word;
        text(name, word);
        if (word == to_string(SolveStatus::suspect)) value = SolveStatus::suspect;
    }

    void names(VariableInfo info, std::vector<std::string>& values)
    {
        if (!file_.has_variable(info.name)) return;
        info.dimensions.push_back(text_dimension(info.name));
        const std::string bytes = file_.text(info);
        const std::size_t width = file_.dimension(info.dimensions.back());
        for (std::size_t i = 0; i < bytes.size(); i += width) {
            const std::string_view row = std::string_view(bytes).substr(i, width);
            values.emplace_back(row.substr(0, row.find_last_not_of('\0') + 1));
        }
    }

    void flags(const VariableInfo& info, std::vector<bool>& values)
    {
        if (!file_.has_variable(info.name)) return;
        const std::vector<signed char> bytes = file_.bytes(info);
        values.assign(bytes.begin(), bytes.end());
    }

    template <class T>
    void list(const VariableInfo& info, std::vector<T>& values)
    {
        if (!file_.has_variable(info.name)) return;
        if constexpr (std::is_same_v<T, int>) {
            values = file_.ints(info);
        } else {
            const std::vector<double> all = file_.doubles(info);
            if constexpr (is_matrix<T>) {
                constexpr std::size_t n = T::rows * T::cols;
                if (all.size() % n != 0)
                    throw IoError("variable " + info.name + " has not the shape that livens writes");
                values.resize(all.size() / n);
                for (std::size_t i = 0; i < values.size(); ++i)
                    std::copy_n(all.data() + i * n, n, values[i].data());
            } else {
                values = all;
            }
        }
    }

    void field(const VariableInfo& info, Field& field)
    {
        if (!file_.has_variable(info.name)) return;
        field.values = file_.doubles(info);
        const std::size_t n_coefficients = file_.dimension(info.dimensions.front());
        const std::size_t n_values = field.values.size() / n_coefficients;
        if (n_values > static_cast<std::size_t>(std::numeric_limits<int>::max()))
            throw IoError("variable " + info.name + " is too large");
        field.n_values = static_cast<int>(n_values);
        field.degree = file_.int_attribute_of(info.name, "degree");
        field.continuous = file_.int_attribute_of(info.name, "continuous") != 0;
    }

private:
    const NetcdfReader& file_;
};

/// Does not compile once a member is added that visit_run() does not know: then raise format_minor and add it
/// there under the new number.
[[maybe_unused]] void all_members_are_visited(const Run& run)
{
    [[maybe_unused]] const auto& [r1, r2, r3, r4, r5, r6, r7, r8, r9, r10, r11, r12, r13, r14, r15] = run;
    [[maybe_unused]] const auto& [m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16, m17,
                                  m18] = run.motion;
    [[maybe_unused]] const auto& [f1, f2, f3, f4, f5] = run.motion.X;
    [[maybe_unused]] const auto& [p1, p2, p3, p4, p5, p6, p7, p8, p9, p10, p11, p12, p13, p14, p15, p16, p17,
                                  p18, p19, p20] = run.report;
    // the last two, the velocity jump, follow from the motion and are not written
    [[maybe_unused]] const auto& [v1, v2, v3, v4, v5, v6, v7, v8, v9, v10, v11, v12, v13, v14, v15] =
        run.verdict;
    [[maybe_unused]] const auto& [b1, b2, b3, b4, b5, b6, b7, b8, b9, b10, b11, b12, b13, b14, b15, b16,
                                  b17, b18] = run.verdict.balance;
}

std::size_t expected_bytes(const Run& run)
{
    const Motion& m = run.motion;
    const std::size_t samples =
        run.output.size() * (run.body_names.size() * 62 + run.joint_names.size() * 12);
    const std::size_t ends = (m.momenta.size() + m.velocities.size() + m.accelerations.size()) * 12;
    return 8 * (samples + ends + m.X.values.size() + m.P.values.size() + m.multipliers.values.size() +
                m.rigidity.values.size() + m.end_multipliers.size() + 32 * m.mesh.ends.size()) +
           2 * run.scenario_text.size() + (64u << 10);
}

void check_model(const Model& model, const Run& run)
{
    bool fits = model.n_bodies() == run.motion.n_bodies && model.n_rows() == run.motion.n_rows &&
                model.joints().size() == run.joint_names.size();
    for (int b = 0; fits && b < model.n_bodies(); ++b) fits = model.bodies()[b].name == run.body_names[b];
    if (!fits) throw IoError("cannot write a run with another model than its own");
}

}   // namespace

Run make_run(const Model& model, Solution solution, const Method& method)
{
    Run run;
    for (const Body& body : model.bodies()) {
        run.body_names.push_back(body.name);
        run.body_is_point.push_back(body.is_point);
        run.centers_of_mass.push_back(body.is_point ? Vector3{} : mass_properties(body.mass).center_of_mass);
    }
    for (const Joint& joint : model.joints()) run.joint_names.push_back(joint.name);
    for (int r = 0; r < model.n_rows(); ++r)
        run.row_labels.push_back(model.joints()[model.row_joint(r)].name + ": " + model.row(r).label);
    run.method = name_of(method);
    run.notes = solution.report.notes;
    for (const auto* of_verdict : {&solution.verdict.remarks, &solution.verdict.reasons})
        run.notes.insert(run.notes.end(), of_verdict->begin(), of_verdict->end());
    run.output = solution.motion.mesh.ends;
    run.motion = std::move(solution.motion);
    run.report = std::move(solution.report);
    run.verdict = std::move(solution.verdict);
    run.version = version;
    return run;
}

std::string run_image(const Model& model, const Run& run)
{
    check_run(run);
    check_model(model, run);
    NetcdfWriter file(expected_bytes(run));
    file.attribute("livens_format", format_major);
    file.attribute("livens_format_minor", format_minor);
    Writing archive(file);
    for (int minor = 0; minor <= format_minor; ++minor) {
        file.attribute(digest_name(minor), digest_of_minor(run, minor));
        visit_run(archive, run, minor);
    }
    DerivedNumbers owner;
    write_derived(file, model, run, owner);
    return sealed(file.image());
}

Run run_from_image(std::string image, const std::string& name)
try {
    check_seal(image);
    const NetcdfReader file(image);
    if (!file.has_attribute("livens_format")) throw IoError("this NetCDF file is no run of livens");
    const long long major = file.int_attribute("livens_format");
    if (major != format_major)
        throw IoError("the file has format " + std::to_string(major) + "; this livens reads format " +
                      std::to_string(format_major));
    const long long minor_of_file = file.int_attribute("livens_format_minor");
    Run run;
    Reading archive(file);
    for (int minor = 0; minor <= format_minor && minor <= minor_of_file; ++minor)
        visit_run(archive, run, minor);
    check_run(run);
    for (int minor = 0; minor <= format_minor && minor <= minor_of_file; ++minor)
        if (digest_of_minor(run, minor) != file.text_attribute(digest_name(minor)))
            throw IoError(
                "the contents do not fit the digest stored with them: the file is damaged or was edited");
    return run;
} catch (const IoError& error) {
    throw IoError("cannot read '" + name + "': " + error.what());
}

void write_run(const std::filesystem::path& file, const Model& model, const Run& run)
{
    check_writable(file);
    const std::string image = run_image(model, run);
    // Proves that the file can be read before it replaces another.
    if (digest(run_from_image(image, file.string())) != digest(run))
        throw IoError("cannot write '" + file.string() + "': what was formed reads back differently");
    replace_file(file, image);
}

Run read_run(const std::filesystem::path& file)
{
    return run_from_image(read_file(file, max_run_bytes), file.string());
}

}   // namespace livens
