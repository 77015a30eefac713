// SPDX-License-Identifier: BSD-3-Clause
// Files that somebody is writing, looked at from time to time.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace livens::program {

/// Knows a change by time, size and inode, so that it does not matter how an editor saves: in place, or by
/// another file that takes the name. A change counts once the files have been left alone for a moment, so
/// that many saves in a row are one, and a file that is gone between two of its versions is not missed.
class WatchedFiles {
public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds quiet{60};   ///< without a change
    static constexpr std::chrono::seconds patience{1};      ///< for a file that has gone

    /// These from now on. Of those that were watched before no change is lost.
    void watch(const std::vector<std::filesystem::path>& files);

    /// Looks; true once for every change.
    bool have_changed(Clock::time_point now = Clock::now());
    /// A change was seen that does not count yet: what is read now may be half of it.
    bool are_changing() const { return is_changed_; }

private:
    struct Stamp {
        std::int64_t seconds = 0, nanoseconds = 0, size = -1;   ///< -1: it is not there
        std::uint64_t inode = 0;

        bool operator==(const Stamp&) const = default;
    };
    struct Watched {
        std::filesystem::path file;
        Stamp stamp;
        bool was_there;   ///< when a change was last told, or at first
    };
    static Watched watched(const std::filesystem::path& file);

    std::vector<Watched> all_;
    Clock::time_point changed_{};
    bool is_changed_ = false;
};

}   // namespace livens::program
