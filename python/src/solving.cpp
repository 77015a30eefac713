// SPDX-License-Identifier: BSD-3-Clause
// From a tree to a scenario, from a scenario to a result; Python is free to do other things meanwhile.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <nanobind/nanobind.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>

#include "livens/dynamics/start/prepared.h"
#include "livens/io/guess.h"
#include "livens/io/scenario/text/tree.h"
#include "livens/io/solve_scenario.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/ensemble.h"
#include "python_load.h"
#include "result.h"
#include "tree.h"

namespace livens::python {

namespace {

using Clock = std::chrono::steady_clock;
using Shared = std::shared_ptr<const Scenario>;

nb::object shared(std::optional<Scenario>& scenario)
{
    if (!scenario) return nb::none();
    return nb::cast(std::make_shared<Scenario>(std::move(*scenario)));
}

/// Of meshes; empty: where Python is.
MeshSource meshes_in(const std::string& folder, std::map<std::string, std::filesystem::path> named = {})
{
    return {folder.empty() ? "." : folder, {}, std::move(named)};
}

/// Work that nobody waits for any more.
std::atomic<int> n_left = 0;

/// work(), in a thread of its own, while this one asks whether Python has a signal. Where it has there is no
/// result, and that thread is left to itself: it holds all it needs, and ends. For what asks nobody itself:
/// meshes that are read.
ScenarioResult read_while_wanted(const std::function<ScenarioResult()>& work)
{
    std::optional<ScenarioResult> result;
    {
        const nb::gil_scoped_release unlock;
        auto task = std::make_shared<std::packaged_task<ScenarioResult()>>(work);
        std::future<ScenarioResult> future = task->get_future();
        ++n_left;
        try {
            std::thread([task]() mutable {
                (*task)();
                task.reset();
                --n_left;
            }).detach();
        } catch (...) {
            --n_left;
            throw;
        }
        const auto is_wanted = [] {
            const nb::gil_scoped_acquire lock;
            return PyErr_CheckSignals() == 0;
        };
        for (auto wait = std::chrono::milliseconds(1); !result; wait = std::chrono::milliseconds(20)) {
            if (future.wait_for(wait) == std::future_status::ready)
                result = future.get();
            else if (!is_wanted())
                break;
        }
    }
    if (!result) throw nb::python_error();
    return std::move(*result);
}

/// Whether a text may name files: all else is read within milliseconds.
bool may_have_meshes(const std::string& text)
{
    return text.find("mesh") != std::string::npos || text.find("include") != std::string::npos;
}

nb::tuple build_text(const std::string& text, const std::string& file, const std::string& folder)
{
    const auto read = [text, file, folder] { return parse_scenario(text, file, meshes_in(folder)); };
    ScenarioResult result;
    if (may_have_meshes(text)) {
        result = read_while_wanted(read);
    } else {
        const nb::gil_scoped_release unlock;
        result = read();
    }
    return nb::make_tuple(shared(result.scenario), to_python(result.diagnostics, nullptr));
}

nb::tuple build_tree(const nb::dict& root, const std::string& text, const std::string& folder,
                     bool model_alone)
{
    TreeReader reader;
    const auto tree = std::make_shared<const Node>(reader.read(root));
    const auto read = [tree, text, meshes = meshes_in(folder, reader.named()), model_alone] {
        return read_tree(*tree, text, meshes, model_alone ? TreePart::model : TreePart::whole);
    };
    ScenarioResult result;
    if (!folder.empty() || may_have_meshes(text)) {
        result = read_while_wanted(read);
    } else {
        const nb::gil_scoped_release unlock;
        result = read();
    }
    return nb::make_tuple(shared(result.scenario), to_python(result.diagnostics, &reader.locations()));
}

/// Asks Python now and then whether someone pressed Ctrl-C, and tells it how far things are: taking the lock
/// at every element would cost more than the elements do.
class Watch {
public:
    explicit Watch(nb::object callback) : callback_(std::move(callback)) {}

    bool goes_on(const Progress& progress)
    {
        if (Clock::now() < next_ && !has_failed_) return !has_failed_;
        next_ = Clock::now() + std::chrono::milliseconds(interval);
        const nb::gil_scoped_acquire lock;
        if (PyErr_Occurred() != nullptr || PyErr_CheckSignals() != 0) return !(has_failed_ = true);
        if (callback_.is_none()) return true;
        try {
            callback_(progress.done, progress.n_elements, progress.t);
        } catch (nb::python_error& error) {
            error.restore();
            has_failed_ = true;
        }
        return !has_failed_;
    }
    bool has_failed() const { return has_failed_; }

private:
    static constexpr int interval = 50;   // ms
    nb::object callback_;
    Clock::time_point next_ = Clock::now() + std::chrono::milliseconds(interval);
    bool has_failed_ = false;
};

/// A motion that was solved and is to be judged.
struct Unjudged {
    Shared scenario;
    SolvedScenario solved;
};

Unjudged solved(const Shared& scenario, const ProgressCallback& progress, double most_bytes,
                const Run* guess = nullptr)
{
    SolveOptions options = scenario->options;
    options.progress = progress;
    options.most_bytes = std::min(options.most_bytes, most_bytes);
    // of its own: threads may solve one scenario at the same time
    return {scenario,
            solve_scenario(*scenario, std::move(options), std::make_shared<Prepared>(),
                           guess != nullptr ? guess_of(*scenario, *guess) : std::function<State(double)>{})};
}

/// What `livens solve` does between solving and writing. Once `goes_on` says no it is given up at once,
/// without the grace that the program has: nobody will see a motion that was interrupted.
Result judged(Unjudged&& motion, const std::function<bool()>& goes_on)
{
    const Method method = motion.solved.solution.method;
    const double seconds = motion.solved.solve_seconds,
                 estimate_seconds = motion.solved.solution.estimate_seconds;
    const Patience patience(goes_on);
    std::vector<std::shared_ptr<Result>> roots;
    for (Run& run : judged_roots(*motion.scenario, motion.solved, {}))
        roots.push_back(std::make_shared<Result>(Result{motion.scenario, std::move(run), method, 0, 0, {}}));
    const Shared scenario = motion.solved.found != nullptr ? motion.solved.found : motion.scenario;
    return {scenario,         judged_run(*motion.scenario, std::move(motion.solved), {}),
            method,           seconds,
            estimate_seconds, std::move(roots)};
}

/// Before the process ends.
void wait_for_the_rest()
{
    const nb::gil_scoped_release unlock;
    while (n_left > 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

Result solve_one(const Shared& scenario, nb::object progress, double most_bytes, const Result* guess)
{
    Watch watch(std::move(progress));
    std::optional<Result> result;
    try {
        const nb::gil_scoped_release unlock;
        Unjudged motion = solved(
            scenario, [&](const Progress& p) { return watch.goes_on(p); }, most_bytes,
            guess != nullptr ? &guess->run : nullptr);
        const auto no_signal = [next = Clock::now(), is_wanted = true]() mutable {
            if (!is_wanted || Clock::now() < next) return is_wanted;
            next = Clock::now() + std::chrono::milliseconds(50);
            const nb::gil_scoped_acquire lock;
            return is_wanted = PyErr_Occurred() == nullptr && PyErr_CheckSignals() == 0;
        };
        if (!watch.has_failed()) result = judged(std::move(motion), no_signal);
    } catch (const InputError&) {
        if (PyErr_Occurred() == nullptr) throw;   // else it follows from what a function has raised
    }
    if (!result || PyErr_Occurred() != nullptr) throw nb::python_error();
    return std::move(*result);
}

/// What became of one of many.
struct Variant {
    Node tree;
    std::string text;
    MeshSource meshes;
    std::vector<Location> locations;
    std::vector<Diagnostic> diagnostics{};
    std::optional<Result> result{};
    std::exception_ptr failure{};
};

/// Reads and solves; another one's failure is no reason to stop.
void solve_variant(Variant& variant, double most_bytes, std::atomic<bool>& is_stopped)
{
    try {
        ScenarioResult read = read_tree(variant.tree, variant.text, variant.meshes);
        variant.tree = {};
        variant.diagnostics = std::move(read.diagnostics);
        if (!read.scenario || is_stopped) return;
        Unjudged motion = solved(
            std::make_shared<Scenario>(std::move(*read.scenario)),
            [&](const Progress&) { return !is_stopped; }, most_bytes);
        if (!is_stopped) variant.result = judged(std::move(motion), [&] { return !is_stopped.load(); });
    } catch (...) {
        variant.failure = std::current_exception();
    }
}

/// False when Python has something to raise.
bool tell(int n_done, const nb::object& progress)
{
    const nb::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) return false;
    if (progress.is_none()) return true;
    try {
        progress(n_done);
        return true;
    } catch (nb::python_error& error) {
        error.restore();
        return false;
    }
}

/// [(tree, text, folder of meshes), ..] -> [(result or None, diagnostics), ..] in their order; what one of
/// them throws is thrown when all have ended.
nb::list solve_many(const nb::list& trees, int n_threads, nb::object progress, double most_bytes)
{
    std::vector<Variant> variants;
    variants.reserve(nb::len(trees));
    for (nb::handle item : trees) {
        const auto triple = nb::cast<nb::tuple>(item);
        TreeReader reader;
        Node tree = reader.read(nb::cast<nb::dict>(triple[0]));
        variants.push_back({std::move(tree), nb::cast<std::string>(triple[1]),
                            meshes_in(nb::cast<std::string>(triple[2]), reader.named()), reader.locations()});
    }
    const int n = static_cast<int>(variants.size()),
              threads = std::min(threads_for(n_threads), std::max(n, 1));
    std::atomic<bool> is_stopped = false;
    std::atomic<int> n_done = 0;
    {
        const nb::gil_scoped_release unlock;
        const auto work = [&](int i) {
            if (!is_stopped)
                solve_variant(variants[static_cast<std::size_t>(i)], most_bytes / threads, is_stopped);
            ++n_done;
        };
        // This thread is Python's: it looks after signals.
        std::future<void> all_done =
            std::async(std::launch::async, [&] { run_in_order(n, threads, work, [](int) {}); });
        while (all_done.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready)
            if (!is_stopped && !tell(n_done, progress)) is_stopped = true;
        all_done.get();
    }
    if (is_stopped) throw nb::python_error();
    nb::list all;
    for (Variant& v : variants) {
        if (v.failure) std::rethrow_exception(v.failure);
        nb::object diagnostics = to_python(v.diagnostics, &v.locations);
        all.append(nb::make_tuple(v.result ? nb::cast(std::move(*v.result)) : nb::none(), diagnostics));
    }
    return all;
}

}   // namespace

void add_solving(nb::module_& m)
{
    nb::class_<Scenario>(m, "Scenario")
        .def_prop_ro("text", [](const Scenario& s) { return s.text; })
        .def_prop_ro("resolved", [](const Scenario& s) { return s.resolved; })
        .def_prop_ro("memory", [](const Scenario& s) { return memory_needed(s).most(); })
        .def(
            "with_load",
            [](const Scenario& s, const std::string& name, const std::string& body, nb::object function) {
                auto copy = std::make_shared<Scenario>(s);
                add_python_load(copy->model, name, body, std::move(function));
                return copy;
            },
            nb::arg("name"), nb::arg("body"), nb::arg("function"))
        .def(
            "with_guard",
            [](const Scenario& s, const std::string& event, nb::object function) {
                auto copy = std::make_shared<Scenario>(s);
                add_python_guard(copy->model, event, std::move(function));
                return copy;
            },
            nb::arg("event"), nb::arg("function"));
    m.def("build_text", &build_text, nb::arg("text"), nb::arg("file"), nb::arg("folder"));
    m.def("build_tree", &build_tree, nb::arg("root"), nb::arg("text"), nb::arg("folder"),
          nb::arg("model_alone") = false);
    m.def("solve", &solve_one, nb::arg("scenario"), nb::arg("progress").none(), nb::arg("most_bytes"),
          nb::arg("guess").none() = nb::none());
    nb::module_::import_("atexit").attr("register")(nb::cpp_function(&wait_for_the_rest));
    m.def("solve_many", &solve_many, nb::arg("trees"), nb::arg("n_threads"), nb::arg("progress").none(),
          nb::arg("most_bytes"));
}

}   // namespace livens::python
