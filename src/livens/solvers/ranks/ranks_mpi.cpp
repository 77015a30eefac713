// SPDX-License-Identifier: BSD-3-Clause
// Ranks that are processes of MPI, and their chain solved by PETSc with MUMPS, which keeps a part of it in
// every process. Without LIVENS_PETSC there are none.
#include <cstdlib>
#include <new>

#include "livens/solvers/ranks.h"

#ifdef LIVENS_HAS_PETSC
#include <petscksp.h>
#endif

namespace livens {

#ifdef LIVENS_HAS_PETSC

namespace {

void check(PetscErrorCode error, const char* what)
{
    if (error == PETSC_ERR_MEM) throw std::bad_alloc();
    if (error != 0)
        throw RankLost(std::string("PETSc fails to ") + what + " (error " + std::to_string(error) + ")");
}

/// Objects of PETSc, which are destroyed by all ranks in one order.
class PetscChain final : public RankChain {
public:
    explicit PetscChain(Ranks& ranks) : ranks_(ranks) {}
    ~PetscChain() override { destroy(); }
    PetscChain(const PetscChain&) = delete;
    PetscChain& operator=(const PetscChain&) = delete;

    /// A direct solution without iterations (KSPPREONLY); memory that ends is an error of its own, no
    /// singular chain.
    bool factorise(const ChainRows& own) override
    {
        destroy();
        assemble(own);
        check(KSPCreate(PETSC_COMM_WORLD, &solver_), "make a solver");
        check(KSPSetOperators(solver_, A_, A_), "take a matrix");
        check(KSPSetType(solver_, KSPPREONLY), "choose a solver");
        PC pc = nullptr;
        check(KSPGetPC(solver_, &pc), "choose a solver");
        check(PCSetType(pc, PCLU), "choose a solver");
        check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS), "find MUMPS");
        check(PCFactorSetUpMatSolverType(pc), "find MUMPS");
        Mat factors = nullptr;
        check(PCFactorGetMatrix(pc, &factors), "find MUMPS");
        check(MatMumpsSetIcntl(factors, 14, 100), "set MUMPS");   // % of memory more than it foresees
        check(MatMumpsSetCntl(factors, 1, 0.1), "set MUMPS");     // rows are exchanged for pivots below
        check(KSPSetUp(solver_), "factorise");
        PetscInt outcome = 0;
        check(MatMumpsGetInfog(factors, 1, &outcome), "ask MUMPS");
        // -9 and -13: workspace and memory
        if (outcome == -9 || outcome == -13) throw std::bad_alloc();
        return ranks_.all(outcome >= 0);
    }

    void solve(std::span<const double> b, std::span<double> x) override
    {
        PetscScalar* values = nullptr;
        check(VecGetArray(b_, &values), "solve");
        std::copy(b.begin(), b.end(), values);
        check(VecRestoreArray(b_, &values), "solve");
        check(KSPSolve(solver_, b_, x_), "solve");
        check(VecScatterBegin(scatter_, x_, wanted_, INSERT_VALUES, SCATTER_FORWARD), "share a solution");
        check(VecScatterEnd(scatter_, x_, wanted_, INSERT_VALUES, SCATTER_FORWARD), "share a solution");
        const PetscScalar* found = nullptr;
        check(VecGetArrayRead(wanted_, &found), "share a solution");
        std::copy_n(found, x.size(), x.begin());
        check(VecRestoreArrayRead(wanted_, &found), "share a solution");
        ranks_.count(1,
                     static_cast<long long>(x.size_bytes()));   // what is not its own comes from neighbours
    }

private:
    void assemble(const ChainRows& own)
    {
        const auto n = static_cast<PetscInt>(own.n_rows()), all = static_cast<PetscInt>(own.n_unknowns);
        const auto width = static_cast<PetscInt>(own.columns.size());
        check(MatCreate(PETSC_COMM_WORLD, &A_), "make a matrix");
        check(MatSetSizes(A_, n, n, all, all), "make a matrix");
        check(MatSetType(A_, MATAIJ), "make a matrix");
        const PetscInt diagonal = std::min(width, n);
        check(MatSeqAIJSetPreallocation(A_, width, nullptr), "make a matrix");
        check(MatMPIAIJSetPreallocation(A_, diagonal, nullptr, width, nullptr), "make a matrix");
        PetscInt first = 0, last = 0;
        check(MatGetOwnershipRange(A_, &first, &last), "make a matrix");
        std::vector<PetscInt> columns;
        std::vector<PetscScalar> values;
        for (PetscInt i = 0; i < n; ++i) {
            columns.clear();
            values.clear();
            for (PetscInt j = 0; j < width; ++j) {
                const double value = own.values[static_cast<std::size_t>(i * width + j)];
                if (value == 0) continue;
                columns.push_back(own.columns[static_cast<std::size_t>(j)]);
                values.push_back(value);
            }
            const PetscInt row = first + i;
            check(MatSetValues(A_, 1, &row, static_cast<PetscInt>(columns.size()), columns.data(),
                               values.data(), INSERT_VALUES),
                  "make a matrix");
        }
        check(MatAssemblyBegin(A_, MAT_FINAL_ASSEMBLY), "make a matrix");
        check(MatAssemblyEnd(A_, MAT_FINAL_ASSEMBLY), "make a matrix");
        check(MatCreateVecs(A_, &x_, &b_), "make a vector");
        check(VecCreateSeq(PETSC_COMM_SELF, width, &wanted_), "make a vector");
        const std::vector<PetscInt> numbers(own.columns.begin(), own.columns.end());
        check(ISCreateGeneral(PETSC_COMM_SELF, width, numbers.data(), PETSC_COPY_VALUES, &places_),
              "share a solution");
        check(VecScatterCreate(x_, places_, wanted_, nullptr, &scatter_), "share a solution");
    }

    void destroy()
    {
        KSPDestroy(&solver_);
        VecScatterDestroy(&scatter_);
        ISDestroy(&places_);
        VecDestroy(&wanted_);
        VecDestroy(&x_);
        VecDestroy(&b_);
        MatDestroy(&A_);
    }

    Ranks& ranks_;
    Mat A_ = nullptr;
    Vec x_ = nullptr, b_ = nullptr, wanted_ = nullptr;
    IS places_ = nullptr;
    VecScatter scatter_ = nullptr;
    KSP solver_ = nullptr;
};

class MpiRanks final : public Ranks {
public:
    MpiRanks()
    {
        // Its own handlers of signals would end the program in the middle of a result.
        check(PetscInitializeNoArguments(), "begin");
        check(PetscPopSignalHandler(), "begin");
        check(PetscPushErrorHandler(PetscReturnErrorHandler, nullptr), "begin");
        MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
        MPI_Comm_size(MPI_COMM_WORLD, &size_);
    }
    ~MpiRanks() override { PetscFinalize(); }
    MpiRanks(const MpiRanks&) = delete;
    MpiRanks& operator=(const MpiRanks&) = delete;

    int rank() const override { return rank_; }
    int size() const override { return size_; }
    std::unique_ptr<RankChain> make_chain() override { return std::make_unique<PetscChain>(*this); }

protected:
    static constexpr std::size_t most = std::size_t{1}
                                        << 27;   // numbers in a message: their bytes fit an int

    void put(int to, std::span<const double> values) override
    {
        do {
            const auto some = values.first(std::min(values.size(), most));
            MPI_Send(some.data(), static_cast<int>(some.size()), MPI_DOUBLE, to, 0, MPI_COMM_WORLD);
            values = values.subspan(some.size());
        } while (!values.empty());
    }
    void take(int from, std::span<double> values) override
    {
        do {
            const auto some = values.first(std::min(values.size(), most));
            MPI_Status status;
            int n = 0;
            MPI_Recv(some.data(), static_cast<int>(some.size()), MPI_DOUBLE, from, 0, MPI_COMM_WORLD,
                     &status);
            MPI_Get_count(&status, MPI_DOUBLE, &n);
            if (n != static_cast<int>(some.size()))
                throw std::logic_error("a message between ranks is not as long as it is expected");
            values = values.subspan(some.size());
        } while (!values.empty());
    }

private:
    int rank_ = 0, size_ = 1;
};

}   // namespace

std::unique_ptr<Ranks> make_mpi_ranks() { return std::make_unique<MpiRanks>(); }

void abort_mpi(int exit_code)
{
    int has_begun = 0;
    MPI_Initialized(&has_begun);
    if (has_begun != 0) MPI_Abort(MPI_COMM_WORLD, exit_code);
}

bool has_mpi() { return true; }

#else

std::unique_ptr<Ranks> make_mpi_ranks() { return nullptr; }
void abort_mpi(int) {}
bool has_mpi() { return false; }

#endif

}   // namespace livens
