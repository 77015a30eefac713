// SPDX-License-Identifier: BSD-3-Clause
// One result file by several processes: a variable's numbers lie in the order of time, so that every process
// has one place in each; a variable's checksum goes from process to process, as its numbers follow each
// other.
#include "livens/io/parts.h"

#include <bit>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "livens/io/results/atomic_file.h"
#include "livens/io/results/writing.h"
#include "livens/io/solve_scenario.h"

namespace livens {

namespace {

class FileOfRanks final : public SharedFile {
public:
    FileOfRanks(const Motion& part, Ranks& ranks) : ranks_(ranks)
    {
        // where neighbours share a value, the one behind leaves it out
        divided_["element_end"] = 1;
        divided_["element"] = 0;
        const std::pair<const char*, const Field*> fields[] = {{"X_node", &part.X},
                                                               {"P_node", &part.P},
                                                               {"multiplier_node", &part.multipliers},
                                                               {"rigidity_node", &part.rigidity}};
        for (const auto& [name, field] : fields) divided_[name] = field->continuous ? 1 : 0;
        if (!part.load_angles.empty())   // of each end as many
            divided_["load_angle"] = part.load_angles.size() / part.mesh.ends.size();
    }

    bool is_first() const override { return ranks_.is_first(); }
    std::optional<Slab> slab(const std::string& dimension, std::uint64_t here) override
    {
        const auto found = divided_.find(dimension);
        if (found == divided_.end()) return {};
        const std::uint64_t skipped = is_first() ? 0 : found->second;
        double own = static_cast<double>(here - skipped);   // exact: numbers of elements are below 2^53
        Slab slab;
        slab.skipped = skipped;
        slab.before = static_cast<std::uint64_t>(ranks_.sum_before({&own, 1})[0]);
        ranks_.sum({&own, 1});
        slab.total = static_cast<std::uint64_t>(own);
        return slab;
    }
    std::uint64_t state_before(int variable) override
    {
        if (is_first()) return Checksum().state();
        for (;;) {   // those of other variables may come before
            if (const auto found = before_.find(variable); found != before_.end()) return found->second;
            double message[2];
            ranks_.receive_from_before(message);
            before_[static_cast<int>(message[0])] = std::bit_cast<std::uint64_t>(message[1]);
        }
    }
    void pass_on(int variable, std::uint64_t state) override
    {
        const double message[] = {static_cast<double>(variable), std::bit_cast<double>(state)};
        ranks_.pass_on(message);
    }
    std::uint64_t last_state(std::uint64_t own) override
    {
        double state = std::bit_cast<double>(own);
        ranks_.broadcast(ranks_.size() - 1, {&state, 1});
        return std::bit_cast<std::uint64_t>(state);
    }

private:
    Ranks& ranks_;
    std::map<std::string, std::uint64_t> divided_;
    std::map<int, std::uint64_t> before_;
};

/// What the first rank says to all.
/// Letters go as numbers, since ranks send nothing else.
std::string told(std::string text, Ranks& ranks)
{
    double size = static_cast<double>(text.size());
    ranks.broadcast(0, {&size, 1});
    std::vector<double> letters(text.begin(), text.end());
    letters.resize(static_cast<std::size_t>(size));
    ranks.broadcast(0, letters);
    std::string said;
    for (const double letter : letters) said += static_cast<char>(letter);
    return said;
}

}   // namespace

Run part_of_run(const Scenario& scenario, Solution part, const RankWork& work)
{
    const Method method = part.method;
    const bool has_numbers = part.numbers.rebuilt.model != nullptr;
    if (has_numbers) tell_found(scenario.unknowns, part);
    Run run = make_run(scenario.model, std::move(part), method);
    run.scenario_text = scenario.text;
    run.meshes = scenario.meshes;
    run.title = scenario.title;
    run.resolved = scenario.resolved;
    if (has_numbers) run.numbers = numbers_of(scenario.unknowns, {});
    run.output = scenario.output.empty() ? work.mesh.ends : scenario.output;
    if (!run.motion.block_ends.empty()) run.motion.block_ends = {0, work.mesh.n_elements()};
    return run;
}

/// The first rank makes the temporary file, into which all write; it gets its name when all of them have. The
/// start is that of the first part, the end that of the last one.
void write_parts(const std::filesystem::path& file, const Scenario& scenario, const Run& part, Ranks& ranks,
                 bool spares_others)
{
    std::optional<AtomicFile> whole;
    std::optional<PartOfFile> own;
    std::string name;
    if (ranks.is_first()) {
        whole.emplace(file, spares_others ? begins_as_run : nullptr);
        name = std::filesystem::absolute(whole->temporary()).string();
    }
    name = told(name, ranks);
    if (!ranks.is_first()) own.emplace(name);
    double start = part.motion.start(), end = part.motion.end();
    ranks.broadcast(0, {&start, 1});
    ranks.broadcast(ranks.size() - 1, {&end, 1});
    ClassicWriter out;
    FileOfRanks shared(part.motion, ranks);
    out.share(shared);
    RunWriter archive(out);
    out.attribute("livens_format", format_major);
    out.attribute("livens_format_minor", format_minor);
    out.attribute("converged", part.report.reached_end() ? 1 : 0);
    out.attribute("start", start);
    out.attribute("end", end);
    visit_run(archive, part);
    write_derived(archive, scenario.model, part, false);
    archive.write([&](std::uint64_t offset, std::string_view bytes) {
        whole ? whole->write(offset, bytes) : own->write(offset, bytes);
    });
    if (own) own->sync();
    ranks.all(true);   // now all of them have
    if (whole) whole->commit();
    ranks.all(true);
}

}   // namespace livens
