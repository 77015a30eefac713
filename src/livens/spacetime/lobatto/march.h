// Element after element from a state at the start.
#pragma once

#include "livens/multibody/assembly.h"
#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"
#include "livens/solvers/report.h"
#include "livens/spacetime/solve.h"
#include "livens/time/time_mesh.h"

namespace livens {

/// Solves the initial value problem with lobatto(degree). The motion ends at the last good element end.
Solution march_lobatto(const Model& model, const Assembly& assembly, const TimeMesh& mesh, int degree,
                       const SolveOptions& options);

}   // namespace livens
