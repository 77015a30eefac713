// SPDX-License-Identifier: BSD-3-Clause
// Files on the disk: written whole or not at all, read where a reader asks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace livens::inline io_internal {

/// A file descriptor that closes itself.
class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(other.number_) { other.number_ = -1; }
    Descriptor& operator=(Descriptor&& other) noexcept;
    ~Descriptor();
    int number() const { return number_; }

private:
    int number_;
};

/// A new file in place of `file`: under a temporary name in the same folder until commit(), which syncs and
/// renames; removed if it does not come to that. See replace_file() for what is promised. Throws IoError.
///
/// Temporaries are named .livens-<process>-<n>.tmp and locked while somebody writes them. Those without a
/// lock, left behind by killed processes, are removed when a process makes its first one there.
class AtomicFile {
public:
    /// `is_own`: of the beginning of a file that may be replaced; see is_occupied(). It is asked last of all,
    /// for a file that came while this one was made.
    explicit AtomicFile(const std::filesystem::path& file, bool (*is_own)(std::string_view head) = nullptr);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::uint64_t offset, std::string_view bytes);
    void commit();
    const std::filesystem::path& temporary() const { return temporary_; }

private:
    void create();
    void take_name();

    std::filesystem::path file_, target_, temporary_;
    bool (*is_own_)(std::string_view head);
    Descriptor out_{-1};
};

/// A part of a file that somebody else has made, and puts in its place.
class PartOfFile {
public:
    /// Throws IoError, where it is not to be seen from here, too.
    explicit PartOfFile(const std::filesystem::path& file);
    void write(std::uint64_t offset, std::string_view bytes);
    void sync();

private:
    std::filesystem::path file_;
    Descriptor out_;
};

/// A regular file; `O_NONBLOCK`, so that a pipe is refused instead of waited for. Throws IoError.
class InputFile {
public:
    explicit InputFile(const std::filesystem::path& file);
    std::uint64_t size() const { return size_; }
    void read(std::uint64_t offset, std::span<char> out) const;

private:
    std::filesystem::path file_;
    Descriptor in_;
    std::uint64_t size_ = 0;
};

}   // namespace livens::inline io_internal
