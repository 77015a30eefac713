// SPDX-License-Identifier: BSD-3-Clause
// Eigen as a stranger uses it, with the stranger's processor flags: sizes that take the blocked, vectorised
// kernels, whose inline functions the linker would share with the library's if both had the same names.
#include <algorithm>

#include <Eigen/Dense>

double own_algebra_residual()
{
    double worst = 0;
    for (const int n : {3, 12, 37, 300}) {
        const Eigen::MatrixXd a = Eigen::MatrixXd::Random(n, n) + n * Eigen::MatrixXd::Identity(n, n);
        const Eigen::VectorXd b = Eigen::VectorXd::Random(n);
        const Eigen::VectorXd lu = a.partialPivLu().solve(b);
        const Eigen::VectorXd qr = a.colPivHouseholderQr().solve(b);
        worst = std::max({worst, (a * lu - b).norm() / b.norm(), (lu - qr).norm() / lu.norm()});
    }
    using Small = Eigen::Matrix<double, 12, 12>;
    const Small a = Small::Random() + 12 * Small::Identity();
    return std::max(worst, (a * a.inverse() - Small::Identity()).norm());
}
