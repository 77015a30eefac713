// SPDX-License-Identifier: BSD-3-Clause
// Loads at all load points of an element, side by side.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "livens/dynamics/lanes/aligned_doubles.h"
#include "livens/dynamics/lanes/lanes.h"
#include "livens/time/time_mesh.h"

namespace livens::inline dynamics_internal {

struct ModelTables;
class LoadProgram;

/// Which loads are recorded. Where elements end because the law of one bends or jumps there, its last digits
/// tell the side, and they are those of Load::forces. No forces, but numbers and factors of laws, or guards
/// and centres: for looks; or what loads supply, see SupplyOnTape.
enum class RecordedLoads { all, without_bends, laws, guards, supplies };

/// The registers of a model's LoadProgram, for one element after the other. Loads that are in no program are
/// asked point by point.
class LoadLanes {
public:
    using Run = void (*)(const lanes::LoadProgram&, const double* X, const double* V, const double* factors,
                         double* F);

    /// `run` is that of `width` lanes, of which n are load points; null: of one. The tables must outlive it.
    LoadLanes(const ModelTables& tables, Run run, int width, int n, RecordedLoads which = RecordedLoads::all);
    LoadLanes(const LoadLanes&) = delete;
    LoadLanes& operator=(const LoadLanes&) = delete;

    int width() const { return width_; }
    const LoadProgram& program() const { return *program_; }
    /// Steps alone, where arms are in their registers. `turns` as of evaluate().
    void run_steps(std::span<const double> turns);
    /// The program and its registers.
    lanes::LoadProgram view() { return view(program_steps()); }
    /// Loads that are in no program.
    bool has_others() const;
    /// F of these as evaluate() has it, alone.
    void evaluate_others(const double* X, const double* V, const double* factors,
                         std::span<const double> turns, double* F);
    /// F <- its sum over all points, 12 numbers a body; `others`: what evaluate_others() found, or null.
    void add_up(const double* factors, const double* others, double* F) const;
    /// The same, and `turns` goes on from lane to lane; of X and V as of evaluate(), or where arms are known.
    void go_on(std::span<double> turns, const double* X = nullptr, const double* V = nullptr);
    /// What was evaluated last, in lanes; `place`: of a number on the program's tape that is needed.
    const double* number(int place) const { return registers_.data() + place * width_; }
    /// The instants of the element's load points.
    void begin(std::span<const Instant> points);
    /// F of all bodies with loads, 12 numbers each in lanes, times `factors`, which are 0 in lanes that are
    /// no points; X, V and F about centres of mass. `turns`: a row of LoadTables::turns at the element's
    /// start.
    void evaluate(const double* X, const double* V, const double* factors, std::span<const double> turns,
                  double* F);

private:
    lanes::LoadProgram view(const std::vector<lanes::LoadStep>& steps);
    const std::vector<lanes::LoadStep>& program_steps() const;
    void add_others(const double* X, const double* V, const double* factors, double* F);
    static void call(void* self, const lanes::LoadStep& step, int lane);

    const ModelTables& tables_;
    std::shared_ptr<const LoadProgram> program_;
    Run run_;
    int width_, n_;
    std::vector<Instant> points_;
    AlignedDoubles registers_;
    std::vector<double> turns_, in_, out_;
    std::vector<double> X_, V_, F_;   // of others, at a point
};

/// The same at one instant, about the reference points.
class LoadsAtInstant {
public:
    /// The tables must outlive it.
    explicit LoadsAtInstant(const ModelTables& tables);

    /// LoadTables::add() once. `far_from_bends`: no law is near one, and all that are recorded are evaluated
    /// so.
    void add(Instant at, const double* X, const double* V, double* raw, std::span<const double> turns,
             bool far_from_bends = false);

private:
    const ModelTables& tables_;
    LoadLanes lanes_, all_;
    std::vector<double> X_, V_, F_;
};

}   // namespace livens::inline dynamics_internal
