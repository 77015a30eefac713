// SPDX-License-Identifier: BSD-3-Clause
// Windows of the paper's elements on models that unknown numbers make (theory.md, "Unknown numbers").
#include "livens/spacetime/mixed/window.h"

namespace livens::inline spacetime_internal {

UnknownsWindow::Maker mixed_windows(const Mixed& method, Ranks* ranks)
{
    struct Own {
        Own(const NumberedProblem::Instance& of, const Mixed& method, Ranks* ranks)
            : tables(*of.rebuilt.model, of.ends.independent, true),
              window(tables, of.mesh, of.ends, method, ranks)
        {}
        ModelTables tables;
        MixedWindow window;
    };
    return [&method, ranks](const NumberedProblem::Instance& of) -> std::shared_ptr<BorderedWindow> {
        auto own = std::make_shared<Own>(of, method, ranks);
        return {own, &own->window};
    };
}

}   // namespace livens::inline spacetime_internal
