// SPDX-License-Identifier: BSD-3-Clause
// Files that are written whole or not at all: into a temporary beside the target, synced, then renamed over
// it. A lock tells temporaries in use from those that a crash has left, which the next writer removes.
#include "livens/io/results/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "livens/io/results.h"

namespace livens {

namespace {

namespace fs = std::filesystem;

std::string quoted(const fs::path& file) { return "'" + file.string() + "'"; }

[[noreturn]] void fail(const std::string& what, int error)
{
    throw IoError(what + ": " + std::generic_category().message(error));
}

/// A signal may interrupt what a call does to a file; then it is called again.
template <class Call>
ssize_t insistent(const Call& call)
{
    for (;;) {
        const ssize_t n = call();
        if (n >= 0 || errno != EINTR) return n;
    }
}

/// The name that a link stands for; a link to nothing yet is followed as well.
fs::path followed(fs::path file)
{
    std::error_code error;
    // The result goes where the link points, as any other program would write it.
    for (int links = 0; fs::is_symlink(fs::symlink_status(file, error)); ++links) {
        const fs::path target = fs::read_symlink(file, error);
        if (links == 40 || error) fail("cannot follow " + quoted(file), links == 40 ? ELOOP : error.value());
        file = target.is_absolute() ? target : file.parent_path() / target;
    }
    return file;
}

fs::path folder_of(const fs::path& file)
{
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

bool is_same(const struct stat& a, const struct stat& b)
{
    return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

/// Removes `file` if it is a temporary that nobody has locked. What is removed is what was locked: no name is
/// used twice by one process.
void remove_abandoned(const fs::path& file)
{
    const Descriptor found(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
    struct stat opened {
    }, named{};
    if (found.number() < 0 || ::flock(found.number(), LOCK_EX | LOCK_NB) != 0) return;
    if (::fstat(found.number(), &opened) != 0 || !S_ISREG(opened.st_mode)) return;
    if (::lstat(file.c_str(), &named) == 0 && is_same(opened, named)) ::unlink(file.c_str());
}

/// ".livens-<digits>-<digits>.tmp"
bool is_temporary(std::string_view name)
{
    constexpr std::string_view head = ".livens-", tail = ".tmp";
    if (!name.starts_with(head) || !name.ends_with(tail) || name.size() <= head.size() + tail.size())
        return false;
    const std::string_view middle = name.substr(head.size(), name.size() - head.size() - tail.size());
    return middle.find_first_not_of("0123456789-") == std::string_view::npos;
}

/// By readdir: the standard's iterator ends the program where memory ends.
void remove_abandoned_in(const fs::path& folder)
{
    const std::unique_ptr<DIR, int (*)(DIR*)> listing(::opendir(folder.c_str()), ::closedir);
    if (!listing) return;
    while (const dirent* entry = ::readdir(listing.get()))
        if (is_temporary(entry->d_name)) remove_abandoned(folder / entry->d_name);
}

/// Whether this process has not looked for abandoned temporaries in this folder yet: a list of the folder for
/// each of many files that are written there would take the square of their number.
bool is_first_visit(const struct stat& folder)
{
    static std::mutex mutex;
    static std::set<std::pair<dev_t, ino_t>> visited;
    const std::lock_guard lock(mutex);
    return visited.emplace(folder.st_dev, folder.st_ino).second;
}

}   // namespace

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept
{
    std::swap(number_, other.number_);
    return *this;
}

Descriptor::~Descriptor()
{
    if (number_ >= 0) ::close(number_);
}

AtomicFile::AtomicFile(const fs::path& file, bool (*is_own)(std::string_view head))
    : file_(file), is_own_(is_own)
{
    const std::string cannot = "cannot write " + quoted(file);
    if (file.empty() || !file.has_filename() || file.filename() == "." || file.filename() == "..")
        throw IoError(cannot + ": it names no file");
    // Asked of the name as it is given: /dev/stdout is a link that leads to a pipe, and to no place on a
    // disk.
    struct stat old {};
    const bool is_there = ::stat(file.c_str(), &old) == 0;
    if (!is_there && errno != ENOENT) fail(cannot, errno);
    if (is_there && S_ISDIR(old.st_mode)) fail(cannot, EISDIR);
    if (is_there && !S_ISREG(old.st_mode))
        throw IoError(cannot + ": it is a device or a pipe; results are files", "io-not-a-file");
    if (is_there && ::access(file.c_str(), W_OK) != 0) fail(cannot, errno);
    target_ = followed(file);
    const fs::path folder = folder_of(target_);
    // A result replaces its predecessor by name, so it is the folder that must be writable.
    struct stat status {};
    if (::stat(folder.c_str(), &status) != 0) fail(cannot + ": folder " + quoted(folder), errno);
    if (!S_ISDIR(status.st_mode)) fail(cannot + ": folder " + quoted(folder), ENOTDIR);
    if (is_first_visit(status)) remove_abandoned_in(folder);
    create();
    if (!is_there || ::fchmod(out_.number(), old.st_mode & 0777) == 0) return;
    const int error = errno;
    ::unlink(temporary_.c_str());
    fail("cannot set the access rights of " + quoted(file), error);
}

void AtomicFile::create()
{
    static std::atomic<unsigned> n_made{0};
    const fs::path folder = folder_of(target_);
    for (int attempt = 0; attempt < 10000; ++attempt) {
        // The name does not contain the target's, which may be as long as the file system allows.
        temporary_ =
            folder / (".livens-" + std::to_string(::getpid()) + "-" + std::to_string(n_made++) + ".tmp");
        out_ = Descriptor(::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
        if (out_.number() < 0 && errno == EEXIST) continue;
        if (out_.number() < 0) fail("cannot write " + quoted(file_) + ": folder " + quoted(folder), errno);
        // Another process may have taken it for abandoned before it was locked.
        struct stat status {};
        ::flock(out_.number(), LOCK_EX);
        if (::fstat(out_.number(), &status) == 0 && status.st_nlink > 0) return;
    }
    throw IoError("cannot write " + quoted(file_) + ": no temporary name is free");
}

AtomicFile::~AtomicFile()
{
    if (out_.number() >= 0 && !temporary_.empty()) ::unlink(temporary_.c_str());
}

namespace {

void write_all(int out, std::uint64_t offset, std::string_view bytes, const fs::path& file)
{
    while (!bytes.empty()) {
        const ssize_t n =
            insistent([&] { return ::pwrite(out, bytes.data(), bytes.size(), static_cast<off_t>(offset)); });
        if (n < 0) fail("cannot write " + quoted(file), errno);
        bytes.remove_prefix(static_cast<std::size_t>(n));
        offset += static_cast<std::uint64_t>(n);
    }
}

}   // namespace

void AtomicFile::write(std::uint64_t offset, std::string_view bytes)
{
    write_all(out_.number(), offset, bytes, file_);
}

PartOfFile::PartOfFile(const fs::path& file)
    : file_(file), out_(::open(file.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW))
{
    if (out_.number() < 0)
        fail("cannot write a part of the result to " + quoted(file) +
                 ", which the first process has made; all of them must see its folder",
             errno);
}

void PartOfFile::write(std::uint64_t offset, std::string_view bytes)
{
    write_all(out_.number(), offset, bytes, file_);
}

void PartOfFile::sync()
{
    if (::fsync(out_.number()) != 0) fail("cannot write " + quoted(file_), errno);
}

/// A name that nobody has is taken only while nobody has it.
void AtomicFile::take_name()
{
    for (int attempt = 0; is_own_ != nullptr && attempt < 100; ++attempt) {
        struct stat there {};
        if (is_occupied(target_, is_own_))
            throw OccupiedError("cannot write " + quoted(file_) +
                                ": another program has just written a file there");
        if (::lstat(target_.c_str(), &there) == 0) break;
#ifdef RENAME_NOREPLACE
        if (::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE) == 0)
            return;
        if (errno == EEXIST) continue;   // what is it?
#endif
        break;   // a file system without such a call
    }
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail("cannot replace " + quoted(file_), errno);
}

void AtomicFile::commit()
{
    if (::fsync(out_.number()) != 0) fail("cannot write " + quoted(file_), errno);
    // Some file systems report a full disk only when a file is closed; the lock lasts until all are.
    if (const int twin = ::dup(out_.number()); twin >= 0 && ::close(twin) != 0)
        fail("cannot write " + quoted(file_), errno);
    take_name();
    temporary_.clear();
    // The new file stands; a folder that cannot be synced (some network file systems) takes nothing back.
    const Descriptor folder(::open(folder_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (folder.number() >= 0) ::fsync(folder.number());
}

void replace_file(const fs::path& file, std::string_view bytes)
{
    AtomicFile out(file);
    out.write(0, bytes);
    out.commit();
}

void check_writable(const fs::path& file) { AtomicFile probe(file); }

InputFile::InputFile(const fs::path& file)
    : file_(file), in_(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK))
{
    const std::string cannot = "cannot read " + quoted(file);
    struct stat status {};
    if (in_.number() < 0 || ::fstat(in_.number(), &status) != 0) fail(cannot, errno);
    if (S_ISDIR(status.st_mode)) fail(cannot, EISDIR);
    if (!S_ISREG(status.st_mode)) throw IoError(cannot + ": it is no regular file", "io-not-a-file");
    size_ = static_cast<std::uint64_t>(status.st_size);
}

void InputFile::read(std::uint64_t offset, std::span<char> out) const
{
    while (!out.empty()) {
        const ssize_t n = insistent(
            [&] { return ::pread(in_.number(), out.data(), out.size(), static_cast<off_t>(offset)); });
        if (n < 0) fail("cannot read " + quoted(file_), errno);
        if (n == 0) throw IoError("it became shorter while it was read", "io-truncated");
        out = out.subspan(static_cast<std::size_t>(n));
        offset += static_cast<std::uint64_t>(n);
    }
}

}   // namespace livens
