#include "livens/io/detail/atomic_file.h"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "livens/io/results.h"

namespace livens {

namespace {

namespace fs = std::filesystem;

std::string quoted(const fs::path& file) { return "'" + file.string() + "'"; }

[[noreturn]] void fail(const std::string& what, const fs::path& file, int error)
{
    throw IoError(what + " " + quoted(file) + ": " + std::generic_category().message(error));
}

/// A file descriptor that closes itself.
class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor()
    {
        if (number_ >= 0) ::close(number_);
    }

    int number() const { return number_; }
    /// The result of close(2): some file systems report a full disk only here.
    int close() { return ::close(std::exchange(number_, -1)); }

private:
    int number_;
};

/// The file under a temporary name; removed unless it was renamed.
class Temporary {
public:
    explicit Temporary(const fs::path& folder)
    {
        for (int attempt = 0;; ++attempt) {
            // The name does not contain the target's, which may be as long as the file system allows.
            path_ =
                folder / (".livens-" + std::to_string(::getpid()) + "-" + std::to_string(attempt) + ".tmp");
            number_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (number_ >= 0) return;
            if (errno != EEXIST || attempt == 10000) fail("cannot create a file in", folder, errno);
        }
    }
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;
    ~Temporary()
    {
        if (!path_.empty()) ::unlink(path_.c_str());
    }

    Descriptor descriptor() { return Descriptor(std::exchange(number_, -1)); }
    const fs::path& path() const { return path_; }
    void rename_to(const fs::path& file)
    {
        if (::rename(path_.c_str(), file.c_str()) != 0) fail("cannot replace", file, errno);
        path_.clear();
    }

private:
    fs::path path_;
    int number_ = -1;
};

void write_all(Descriptor& out, std::string_view bytes, const fs::path& file)
{
    while (!bytes.empty()) {
        const ssize_t n = ::write(out.number(), bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) fail("cannot write", file, errno);
        bytes.remove_prefix(static_cast<std::size_t>(n));
    }
}

/// Next bytes of a file into `buffer`; 0 at its end.
std::size_t read_some(const Descriptor& in, char* buffer, std::size_t size, const fs::path& file)
{
    for (;;) {
        const ssize_t n = ::read(in.number(), buffer, size);
        if (n >= 0) return static_cast<std::size_t>(n);
        if (errno != EINTR) fail("cannot read", file, errno);
    }
}

void compare_all(const fs::path& temporary, std::string_view bytes, const fs::path& file)
{
    const Descriptor in(::open(temporary.c_str(), O_RDONLY | O_CLOEXEC));
    if (in.number() < 0) fail("cannot read back", file, errno);
    std::string buffer(1u << 20, '\0');
    for (;;) {
        const std::size_t n = read_some(in, buffer.data(), buffer.size(), file);
        if (n > bytes.size() || std::memcmp(buffer.data(), bytes.data(), n) != 0 ||
            (n == 0 && !bytes.empty()))
            throw IoError("what was written for " + quoted(file) +
                          " reads back differently; the disk may be failing");
        if (n == 0) return;
        bytes.remove_prefix(n);
    }
}

/// The name that a link stands for; a link to nothing yet is followed as well.
fs::path followed(fs::path file)
{
    std::error_code error;
    for (int links = 0; fs::is_symlink(fs::symlink_status(file, error)); ++links) {
        if (links == 40) fail("cannot follow", file, ELOOP);
        const fs::path target = fs::read_symlink(file, error);
        if (error) fail("cannot follow", file, error.value());
        file = target.is_absolute() ? target : file.parent_path() / target;
    }
    return file;
}

fs::path folder_of(const fs::path& file)
{
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

}   // namespace

void replace_file(const fs::path& file, std::string_view bytes)
{
    check_writable(file);
    const fs::path target = followed(file);
    Temporary temporary(folder_of(target));
    Descriptor out = temporary.descriptor();
    struct stat old {};
    if (::stat(target.c_str(), &old) == 0 && ::fchmod(out.number(), old.st_mode & 07777) != 0)
        fail("cannot set the access rights of", file, errno);
    write_all(out, bytes, file);
    if (::fsync(out.number()) != 0) fail("cannot write", file, errno);
    if (out.close() != 0) fail("cannot write", file, errno);
    compare_all(temporary.path(), bytes, file);
    temporary.rename_to(target);
    // The new file stands; a folder that cannot be synced (some network file systems) takes nothing back.
    const Descriptor folder(::open(folder_of(target).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (folder.number() >= 0) ::fsync(folder.number());
}

std::string read_file(const fs::path& file, std::uintmax_t limit)
{
    // O_NONBLOCK: opening a pipe must not wait for a writer; it means nothing for regular files.
    const Descriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (in.number() < 0) fail("cannot open", file, errno);
    struct stat status {};
    if (::fstat(in.number(), &status) != 0) fail("cannot read", file, errno);
    if (S_ISDIR(status.st_mode)) fail("cannot read", file, EISDIR);
    if (!S_ISREG(status.st_mode)) throw IoError("cannot read " + quoted(file) + ": it is no regular file");
    const std::uintmax_t size = static_cast<std::uintmax_t>(status.st_size);
    if (size > limit)
        throw IoError("cannot read " + quoted(file) + ": it has " + std::to_string(size) +
                      " bytes, at most " + std::to_string(limit) + " are read");
    std::string bytes(size, '\0');
    std::size_t done = 0;
    while (done < bytes.size()) {
        const std::size_t n = read_some(in, bytes.data() + done, bytes.size() - done, file);
        if (n == 0) break;
        done += n;
    }
    bytes.resize(done);
    return bytes;
}

void check_writable(const fs::path& file)
{
    if (file.empty() || !file.has_filename() || file.filename() == "." || file.filename() == "..")
        throw IoError("cannot write " + quoted(file) + ": it names no file");
    const fs::path target = followed(file);
    const fs::path folder = folder_of(target);
    struct stat status {};
    if (::stat(folder.c_str(), &status) != 0)
        fail("cannot write " + quoted(file) + ": folder", folder, errno);
    if (!S_ISDIR(status.st_mode)) fail("cannot write " + quoted(file) + ": folder", folder, ENOTDIR);
    if (::stat(target.c_str(), &status) == 0) {
        if (S_ISDIR(status.st_mode)) fail("cannot write", file, EISDIR);
        if (!S_ISREG(status.st_mode))
            throw IoError("cannot write " + quoted(file) + ": it is a device or a pipe; results are files");
        if (::access(target.c_str(), W_OK) != 0) fail("cannot write", file, errno);
    } else if (errno != ENOENT) {
        fail("cannot write", file, errno);
    }
    // A result replaces its predecessor by name, so it is the folder that must be writable.
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        fail("cannot write " + quoted(file) + ": folder", folder, errno);
}

}   // namespace livens
