// SPDX-License-Identifier: BSD-3-Clause
#include "watched_files.h"

#include <algorithm>

#include <sys/stat.h>

namespace livens::program {

WatchedFiles::Watched WatchedFiles::watched(const std::filesystem::path& file)
{
    struct stat there {};
    if (::stat(file.c_str(), &there) != 0) return {file, {}, false};
    return {file, {there.st_mtim.tv_sec, there.st_mtim.tv_nsec, there.st_size, there.st_ino}, true};
}

void WatchedFiles::watch(const std::vector<std::filesystem::path>& files)
{
    std::vector<Watched> all;
    for (const std::filesystem::path& file : files) {
        const auto known = std::ranges::find(all_, file, &Watched::file);
        all.push_back(known == all_.end() ? watched(file) : *known);
    }
    all_ = std::move(all);
}

bool WatchedFiles::have_changed(Clock::time_point now)
{
    bool is_gone = false;
    for (Watched& one : all_) {
        const Stamp stamp = watched(one.file).stamp;
        is_gone |= one.was_there && stamp.size < 0;
        if (stamp == one.stamp) continue;
        one.stamp = stamp;
        changed_ = now;
        is_changed_ = true;
    }
    if (!is_changed_ || now - changed_ < (is_gone ? Clock::duration(patience) : quiet)) return false;
    for (Watched& one : all_) one.was_there = one.stamp.size >= 0;
    is_changed_ = false;
    return true;
}

}   // namespace livens::program
