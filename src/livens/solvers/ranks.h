// SPDX-License-Identifier: BSD-3-Clause
// Processes that solve one motion together, each with a part of time.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

namespace [[gnu::visibility("default")]] livens {

/// Another rank is lost, or has failed: nobody can go on.
struct RankLost : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// What a rank has sent, everything counted: what is reduced and shared goes as such messages, too.
struct Traffic {
    long long messages = 0, bytes = 0;
};

/// Rows of a chain that a rank has left, dense, row by row, in these of the unknowns of the chain. All ranks'
/// rows together are as many as it has unknowns.
struct ChainRows {
    int n_unknowns = 0;         ///< of the whole chain
    std::vector<int> columns;   ///< numbers of unknowns, ascending
    std::vector<double> values;

    int n_rows() const { return columns.empty() ? 0 : static_cast<int>(values.size() / columns.size()); }
};

/// The system that is left when every rank has eliminated what is its own. All ranks call in the same order.
class RankChain {
public:
    virtual ~RankChain() = default;
    /// False, on all ranks: singular.
    virtual bool factorise(const ChainRows& own) = 0;
    /// Right side of the rank's rows in, unknowns of its columns out.
    virtual void solve(std::span<const double> b, std::span<double> x) = 0;
};

/// Ranks as one of them sees them. All but send() and receive() is called by all ranks in the same order. A
/// rank that is lost ends all others: RankLost.
class Ranks {
public:
    Ranks() = default;
    Ranks(const Ranks&) = delete;
    Ranks& operator=(const Ranks&) = delete;
    virtual ~Ranks() = default;

    virtual int rank() const = 0;
    virtual int size() const = 0;
    bool is_first() const { return rank() == 0; }
    bool is_last() const { return rank() == size() - 1; }

    void send(int to, std::span<const double> values);
    void receive(int from, std::span<double> values) { take(from, values); }
    /// What the rank before has, where there is one; see pass_on().
    void receive_from_before(std::span<double> values);
    void pass_on(std::span<const double> values);   ///< to the rank behind, if there is one
    void broadcast(int from, std::span<double> values);
    /// The largest of each number over all ranks; nan where one of them is.
    void largest(std::span<double> values);
    double largest(double value)
    {
        largest(std::span(&value, 1));
        return value;
    }
    bool all(bool is) { return largest(is ? 0.0 : 1.0) == 0; }
    /// The sums over all ranks, added in one order.
    void sum(std::span<double> values);
    /// The sums over the ranks before this one.
    std::vector<double> sum_before(std::span<const double> values);

    /// By a distributed solver, or gathered by the first rank.
    virtual std::unique_ptr<RankChain> make_chain();
    const Traffic& traffic() const { return traffic_; }
    /// What others have sent for this rank.
    void count(long long messages, long long bytes)
    {
        traffic_.messages += messages;
        traffic_.bytes += bytes;
    }

protected:
    virtual void put(int to, std::span<const double> values) = 0;
    virtual void take(int from, std::span<double> values) = 0;

private:
    /// Along a tree to the first rank, and back.
    void reduce(std::span<double> values, double (*join)(double, double));

    Traffic traffic_;
};

/// A chain whose rows are gathered and solved by the first rank.
class GatheredChain final : public RankChain {
public:
    explicit GatheredChain(Ranks& ranks);
    ~GatheredChain() override;
    bool factorise(const ChainRows& own) override;
    void solve(std::span<const double> b, std::span<double> x) override;

private:
    struct Whole;
    Ranks& ranks_;
    std::size_t n_own_ = 0;
    std::unique_ptr<Whole> whole_;   // of the first rank
};

/// Calls work(ranks) for each of n ranks, in threads of this process: for tests, and to count what many ranks
/// would send. What one of them throws ends all, and is thrown on.
void run_as_ranks(int n, const std::function<void(Ranks&)>& work);

/// Of the job that this process was started in by mpirun; null where the build has no PETSc. The first call
/// begins MPI; the last rank to be destroyed ends it.
std::unique_ptr<Ranks> make_mpi_ranks();
/// Ends all processes of the job, if there is one that has begun, with this exit code.
void abort_mpi(int exit_code);
bool has_mpi();

}   // namespace gnu::visibility("default")]]livens
