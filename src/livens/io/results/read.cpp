// SPDX-License-Identifier: BSD-3-Clause
// Reads a run by the same walk that writes it (layout.h): each variable must have the type and the shape that
// livens writes. Figures of later minor formats may be missing in older files (docs/results.md).
#include <limits>
#include <optional>
#include <set>

#include "livens/base/text.h"
#include "livens/io/json.h"
#include "livens/io/results/atomic_file.h"
#include "livens/io/results/figures.h"
#include "livens/io/results/layout.h"

namespace livens {

namespace {

[[noreturn]] void refuse(const std::string& what) { throw IoError(what, "io-damaged"); }

/// An archive (see layout.h) that reads; what is not in the file stays empty.
class RunReader {
public:
    explicit RunReader(const ClassicReader& file) : file_(file) {}

    void figures(Run& run)
    {
        for (const Figure& figure : run_figures()) {
            const std::optional<double> value = file_.number(figure.name);
            // A figure that came with a later minor format keeps its default.
            if (!value && figure.since > file_.number("livens_format_minor").value_or(0)) continue;
            if (!value) refuse(std::string("attribute ") + figure.name + " is missing or no number");
            if (!set_figure(run, figure, *value))
                refuse(std::string("attribute ") + figure.name + " is out of range");
        }
    }
    /// One of the words that to_string() has for 0 to `last`.
    template <class Choice>
    void choice(const std::string& name, Choice& value, Choice last)
    {
        std::string text;
        word(name, text);
        for (int i = 0; i <= static_cast<int>(last); ++i) {
            value = static_cast<Choice>(i);
            if (text == to_string(value)) return;
        }
        refuse("attribute " + name + " has no known value");
    }
    void word(const std::string& name, std::string& value)
    {
        const AttributeValue* found = file_.attribute(name);
        const std::string* text = found == nullptr ? nullptr : std::get_if<std::string>(found);
        if (text == nullptr) refuse("attribute " + name + " is missing or no text");
        value = *text;
    }
    void text(const std::string& name, const char*, std::string& value)
    {
        const ClassicVariable* v = find({name, {name + "_length"}}, NumberType::text);
        if (v != nullptr) value = file_.bytes(*v);
    }
    void names(const std::string& name, const char*, std::vector<std::string>& values)
    {
        const ClassicVariable* v = find({name, {name, name + "_length"}}, NumberType::text);
        if (v == nullptr) return;
        const std::string bytes = file_.bytes(*v);
        const std::size_t width = file_.dimension(v->dimensions.back());
        for (std::size_t i = 0; i < bytes.size(); i += width) {
            const std::string_view row = std::string_view(bytes).substr(i, width);
            // The zeros that fill a row up are no part of the name.
            values.emplace_back(row.substr(0, row.find_last_not_of('\0') + 1));
        }
    }
    void flags(const VariableInfo& info, std::vector<bool>& values)
    {
        const ClassicVariable* v = find(info, NumberType::byte);
        if (v == nullptr) return;
        const std::string bytes = file_.bytes(*v);
        values.assign(bytes.begin(), bytes.end());
    }
    template <class T>
    void list(const VariableInfo& info, std::vector<T>& values)
    {
        const ClassicVariable* v =
            find(info, std::is_same_v<T, int> ? NumberType::integer : NumberType::real);
        if (v == nullptr) return;
        if constexpr (is_matrix<T>) {
            constexpr std::size_t n = T::rows * T::cols;
            if (v->n_values % n != 0)
                refuse("variable " + info.name + " has not the shape that livens writes");
            values.resize(v->n_values / n);
            file_.read(*v, numbers(values));
        } else {
            values.resize(v->n_values);
            file_.read(*v, std::span<T>(values));
        }
    }
    void field(const VariableInfo& info, Field& field)
    {
        list(info, field.values);
        if (field.empty()) return;
        const std::size_t n = field.values.size() / file_.dimension(info.dimensions.front());
        if (n > static_cast<std::size_t>(std::numeric_limits<int>::max()))
            refuse("variable " + info.name + " is too large");
        field.n_values = static_cast<int>(n);
        field.degree = integer_of(info.name, "degree");
        field.continuous = integer_of(info.name, "continuous") != 0;
        field.points = points_of(info.name);
    }
    /// Damage is told wherever it is, also in what livens itself makes anew.
    void verify_rest() const
    {
        for (const ClassicVariable& v : file_.variables())
            if (!seen_.contains(&v)) file_.verify(v);
    }

private:
    /// nullptr: there is none.
    const ClassicVariable* find(const VariableInfo& info, NumberType type)
    {
        const ClassicVariable* v = file_.variable(info.name);
        if (v != nullptr && (v->type != type || v->dimensions != info.dimensions))
            refuse("variable " + info.name + " has not the shape that livens writes");
        if (v != nullptr && v->n_values == 0)   // nobody divides by the length of a dimension before
            refuse("variable " + info.name + " has a dimension of length 0; livens leaves out what is empty");
        seen_.insert(v);
        return v;
    }
    int integer_of(const std::string& variable, const char* attribute) const
    {
        const AttributeValue* value = find_attribute(file_.variable(variable)->attributes, attribute);
        const int* number = value == nullptr ? nullptr : std::get_if<int>(value);
        if (number == nullptr) refuse("variable " + variable + " lacks its " + attribute);
        return *number;
    }

    Points points_of(const std::string& variable) const
    {
        const AttributeValue* value = find_attribute(file_.variable(variable)->attributes, "nodes");
        const std::string* words = value == nullptr ? nullptr : std::get_if<std::string>(value);
        for (const Points points : {Points::lobatto, Points::radau})
            if (words != nullptr && *words == words_for(points)) return points;
        refuse("variable " + variable + " has nodes that this livens does not know");
    }

    const ClassicReader& file_;
    std::set<const ClassicVariable*> seen_;
};

/// The options stand as they are within JSON of our own.
void check_options(const Run& run)
{
    if (!run.resolved.empty() && !(run.resolved.starts_with('{') && is_json(run.resolved)))
        refuse("variable options is no JSON object");
}

/// Whether this file is one that this livens reads.
void check_version(const ClassicReader& file)
{
    const std::optional<double> major = file.number("livens_format");
    if (!major) throw IoError("it is NetCDF, but no run of livens", "io-foreign");
    if (*major != format_major)
        throw IoError("the file has format " + to_text(*major) + "; this livens reads format " +
                          std::to_string(format_major),
                      "io-version");
    file.verify_header();
}

/// Opens a file and calls `work` with it; says of what file an error is.
template <class Work>
auto with_file(const std::filesystem::path& path, Work work)
{
    const InputFile in(path);
    try {
        return work({in.size(), [&](std::uint64_t offset, std::span<char> out) { in.read(offset, out); }});
    } catch (const IoError& error) {
        throw IoError("cannot read '" + path.string() + "': " + error.what(), error.code());
    }
}

}   // namespace

Run io_internal::read_run_from(ByteSource source, bool verify)
{
    const ClassicReader file(std::move(source), verify);
    check_version(file);
    Run run;
    RunReader archive(file);
    visit_run(archive, run);
    archive.verify_rest();
    check_options(run);
    // These follow from others, and are not stored twice.
    run.estimate.n_bodies = run.motion.n_bodies;
    run.estimate.n_joints = run.estimate.reaction.empty() ? 0 : static_cast<int>(run.joint_names.size());
    // Sizes of all parts must fit each other before anything indexes one by another.
    check_run(run);
    if (!run.estimate.empty()) run.estimate.find_largest(run.motion.mesh);
    return run;
}

Run read_run(const std::filesystem::path& file)
{
    return with_file(file, [](ByteSource source) { return read_run_from(std::move(source)); });
}

RunHead read_run_head(const std::filesystem::path& path)
{
    return with_file(path, [](ByteSource source) {
        const ClassicReader file(std::move(source));
        check_version(file);
        RunHead head;
        RunReader archive(file);
        // The head alone: what a file is can be told without reading the motion.
        visit_head(archive, head.run);
        check_options(head.run);
        head.start = file.number("start").value_or(0);
        head.end = file.number("end").value_or(0);
        head.n_output_times = static_cast<long long>(file.dimension("output"));
        return head;
    });
}

}   // namespace livens
