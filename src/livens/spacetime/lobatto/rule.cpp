#include "livens/spacetime/lobatto/rule.h"

#include <string>

#include "livens/base/error.h"
#include "livens/time/basis.h"
#include "livens/time/quadrature.h"

namespace livens {

LobattoRule lobatto_rule(int degree)
{
    if (degree < 1 || degree > 16)
        throw InputError({"degree-out-of-range", "method.degree", "lobatto elements have degree 1 to 16",
                          std::to_string(degree), "1..16", "", "4 to 8 suit most mechanisms"});
    const LagrangeBasis basis = lobatto_basis(degree);
    const int n = degree + 1;
    LobattoRule rule{degree, basis.nodes(), gauss_lobatto(n).weights, basis.differentiation(), {}};
    rule.k.assign(static_cast<std::size_t>(n * n), 0.0);
    for (int a = 0; a < n; ++a) {
        for (int b = 0; b <= a; ++b) {
            long double sum = 0;
            for (int c = 0; c < n; ++c)
                sum += static_cast<long double>(rule.weights[c]) * rule.D[c * n + a] * rule.D[c * n + b];
            rule.k[a * n + b] = rule.k[b * n + a] = static_cast<double>(sum);
        }
    }
    return rule;
}

}   // namespace livens
