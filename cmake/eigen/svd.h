// SPDX-License-Identifier: BSD-3-Clause
// The same of JacobiSVD, which ends the life of a member before another one takes its place; see storage.h.
// Both take the new one in, once there is one.
#pragma once

namespace Eigen::internal {

template <>
inline void
qr_preconditioner_impl<MatrixXd, ColPivHouseholderQRPreconditioner, PreconditionIfMoreRowsThanCols,
                       true>::allocate(const JacobiSVD<MatrixXd>& svd)
{
    if (svd.rows() != m_qr.rows() || svd.cols() != m_qr.cols()) m_qr = QRType(svd.rows(), svd.cols());
    if (svd.m_computeFullU)
        m_workspace.resize(svd.rows());
    else if (svd.m_computeThinU)
        m_workspace.resize(svd.cols());
}

template <>
inline void
qr_preconditioner_impl<MatrixXd, ColPivHouseholderQRPreconditioner, PreconditionIfMoreColsThanRows,
                       true>::allocate(const JacobiSVD<MatrixXd>& svd)
{
    if (svd.cols() != m_qr.rows() || svd.rows() != m_qr.cols()) m_qr = QRType(svd.cols(), svd.rows());
    if (svd.m_computeFullV)
        m_workspace.resize(svd.cols());
    else if (svd.m_computeThinV)
        m_workspace.resize(svd.rows());
    m_adjoint.resize(svd.cols(), svd.rows());
}

}   // namespace Eigen::internal
