// SPDX-License-Identifier: BSD-3-Clause
#include "memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string_view>

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include "failure.h"

namespace livens::program {

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// The number after a word in a file of the kernel's; `otherwise` if there is none.
double number_after(const std::string& file, std::string_view word, double otherwise)
{
    std::ifstream in(file);
    for (std::string found; in >> found;)
        if (double value = 0; found == word && in >> value) return value;
    return otherwise;
}

double first_number(const std::string& file, double otherwise)
{
    std::ifstream in(file);
    double value = 0;
    return in >> value ? value : otherwise;   // "max": no limit
}

double machine_left()
{
    constexpr double kibibyte = 1024;
    const double free = number_after("/proc/meminfo", "MemAvailable:", unlimited);
    return kibibyte * (free + number_after("/proc/meminfo", "SwapFree:", 0));
}

double address_space_left()
{
    rlimit limit{};
    if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
    const double pages = first_number("/proc/self/statm", 0);
    return static_cast<double>(limit.rlim_cur) - pages * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

/// Of a control group, as containers have them: what is cached of files can be had back.
double group_left()
{
    std::ifstream in("/proc/self/cgroup");
    for (std::string line; std::getline(in, line);) {
        if (!line.starts_with("0::")) continue;
        const std::string group = "/sys/fs/cgroup" + line.substr(3);
        return first_number(group + "/memory.max", unlimited) -
               number_after(group + "/memory.stat", "anon", 0);
    }
    return unlimited;
}

}   // namespace

double memory_left() { return std::max(0.0, std::min({machine_left(), address_space_left(), group_left()})); }

std::string bytes_in_words(double bytes)
{
    return bytes < 1e9 ? fmt::format("{:.0f} MB", bytes / 1e6) : fmt::format("{:.1f} GB", bytes / 1e9);
}

void check_memory(const std::vector<const Scenario*>& scenarios, int at_a_time)
{
    std::vector<MemoryNeed> needs;
    for (const Scenario* scenario : scenarios) needs.push_back(memory_needed(*scenario));
    std::ranges::sort(needs, std::ranges::greater{}, &MemoryNeed::most);
    double all = 0;
    for (int i = 0; i < at_a_time && i < static_cast<int>(needs.size()); ++i) all += needs[i].most();
    const double left = memory_left();
    if (all <= left) return;
    const MemoryNeed& largest = needs.front();
    const bool is_one = largest.most() > left;
    const char* const advice = !is_one ? "fewer at a time ('--jobs') need less"
                               : largest.system > largest.motion
                                   ? "fewer elements at once ('window' in [method]) need less"
                                   : "fewer elements need less; a higher degree makes up for it";
    throw failure(exit_resources,
                  fmt::format("{} would take at least {} of memory, and {} is available; {}",
                              is_one ? "the run" : fmt::format("{} runs at a time", at_a_time),
                              bytes_in_words(is_one ? largest.most() : all), bytes_in_words(left), advice));
}

}   // namespace livens::program
