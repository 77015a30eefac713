// SPDX-License-Identifier: BSD-3-Clause
// The DevTools protocol by pipes (--remote-debugging-pipe): messages are JSON, each ended by a zero byte; the
// browser reads them from descriptor 3 and writes to 4, and ends when its pipes are closed.
#include "livens/io/exports/browser.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "livens/io/json.h"
#include "livens/io/results.h"
#include "livens/solvers/patience.h"

extern char** environ;

namespace livens {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int slice = 10;                               // ms between looks whether it is still wanted
constexpr std::chrono::seconds farewell{3};             // for a browser that was asked to end
constexpr std::chrono::seconds patience_of_pages{60};   // until the page has begun
constexpr const char* fault = "browser";

constexpr const char* programs[] = {"chromium", "chromium-browser", "google-chrome", "google-chrome-stable",
                                    "chrome",   "microsoft-edge",   "brave-browser"};

std::string in_path(const std::string& name)
{
    const char* const all = std::getenv("PATH");
    std::string_view rest = all != nullptr ? all : "";
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find(':'), rest.size());
        const std::string file = std::string(rest.substr(0, end)) + "/" + name;
        if (::access(file.c_str(), X_OK) == 0) return file;
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return {};
}

fs::path new_folder()
{
    std::string name = (fs::temp_directory_path() / "livens-browser-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
        throw IoError("no temporary folder can be made: " + std::string(std::strerror(errno)), fault);
    return name;
}

/// Ends that processes do not inherit: of a socket, since writing to a pipe whose reader has gone is a
/// signal.
std::array<int, 2> new_pipe()
{
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) != 0)
        throw IoError("no pipe can be made: " + std::string(std::strerror(errno)), fault);
    // Numbers that the browser's own two do not overwrite.
    for (int& end : ends) {
        const int moved = ::fcntl(end, F_DUPFD_CLOEXEC, 10);
        ::close(end);
        end = moved;
    }
    if (ends[0] < 0 || ends[1] < 0) throw IoError("no pipe can be made: too many files are open", fault);
    return ends;
}

std::vector<std::string> arguments_of(const std::string& program, const fs::path& folder)
{
    std::vector<std::string> all{
        program,
        "--headless=new",
        "--remote-debugging-pipe",
        "--user-data-dir=" + (folder / "profile").string(),
        "--no-first-run",
        "--no-default-browser-check",
        "--disable-background-networking",
        "--disable-component-update",
        "--disable-extensions",
        "--disable-sync",
        "--disable-breakpad",
        "--disable-dev-shm-usage",
        "--enable-unsafe-swiftshader",   // a picture in space without a graphics card
        "--password-store=basic",
        "--mute-audio",
        "about:blank"};
    if (::geteuid() == 0) all.emplace_back("--no-sandbox");   // it refuses to run as root otherwise
    return all;
}

void append_utf8(std::string& out, unsigned code)
{
    if (code < 0x80) {
        out += static_cast<char>(code);
    } else if (code < 0x800) {
        out += static_cast<char>(0xc0 | code >> 6);
        out += static_cast<char>(0x80 | (code & 63));
    } else {
        out += static_cast<char>(0xe0 | code >> 12);
        out += static_cast<char>(0x80 | (code >> 6 & 63));
        out += static_cast<char>(0x80 | (code & 63));
    }
}

}   // namespace

std::string io_internal::browser_program()
{
    if (const char* const chosen = std::getenv("CHROMIUM"); chosen != nullptr && *chosen != '\0')
        return ::access(chosen, X_OK) == 0 ? chosen : in_path(chosen);
    for (const char* const name : programs)
        if (std::string file = in_path(name); !file.empty()) return file;
    return {};
}

/// The first member of this name, at any depth, if it is a string: answers are small and known, and the
/// browser writes no blanks.
std::string io_internal::string_member(std::string_view json, std::string_view key)
{
    const std::string before = "\"" + std::string(key) + "\":\"";
    const std::size_t start = json.find(before);
    if (start == std::string_view::npos) return {};
    std::string out;
    for (std::size_t i = start + before.size(); i < json.size() && json[i] != '"'; ++i) {
        if (json[i] != '\\') {
            out += json[i];
            continue;
        }
        const char c = ++i < json.size() ? json[i] : ' ';
        if (c == 'u') {
            append_utf8(out, static_cast<unsigned>(
                                 std::strtoul(std::string(json.substr(i + 1, 4)).c_str(), nullptr, 16)));
            i += 4;
        } else {
            out += c == 'n' ? '\n' : c == 't' ? '\t' : c;
        }
    }
    return out;
}

/// Six bits a letter, up to the first '='. Letters are not checked: the page has made them.
std::string io_internal::from_base64(std::string_view text)
{
    constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<int, 256> values{};
    for (std::size_t i = 0; i < letters.size(); ++i)
        values[static_cast<unsigned char>(letters[i])] = static_cast<int>(i);
    std::string out;
    out.reserve(text.size() / 4 * 3);
    std::uint32_t bits = 0;
    int n = 0;
    for (const char c : text) {
        if (c == '=') break;
        bits = bits << 6 | static_cast<std::uint32_t>(values[static_cast<unsigned char>(c)]);
        if ((n += 6) >= 8) out += static_cast<char>(bits >> (n -= 8) & 0xff);
    }
    return out;
}

Browser::Browser()
{
    const std::string program = browser_program();
    if (program.empty())
        throw IoError(
            "pictures are drawn by a browser without a window, and none was found; install Chromium or "
            "Chrome (Debian: apt install chromium), or set CHROMIUM to its program. Without one: the page "
            "that 'livens view RUN.nc' shows, and sol.report() in Python writes, has a button 'Save', which "
            "makes the same files in any browser",
            "browser-missing");
    folder_ = new_folder();
    try {
        start(program);
    } catch (...) {
        std::error_code error;
        fs::remove_all(folder_, error);
        throw;
    }
}

/// What it says of itself goes into a file, the last line of which is told if it ends too soon.
void Browser::start(const std::string& program)
{
    const std::array<int, 2> in = new_pipe(), out = new_pipe();
    const std::string told = (folder_ / "told").string();
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, 2, told.c_str(), O_WRONLY | O_CREAT, 0600);
    ::posix_spawn_file_actions_adddup2(&actions, in[0], 3);
    ::posix_spawn_file_actions_adddup2(&actions, out[1], 4);
    posix_spawnattr_t attributes;
    ::posix_spawnattr_init(&attributes);
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);   // with all that it starts
    std::vector<std::string> words = arguments_of(program, folder_);
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    const int code =
        ::posix_spawn(&process_, program.c_str(), &actions, &attributes, pointers.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::posix_spawnattr_destroy(&attributes);
    ::close(in[0]);
    ::close(out[1]);
    to_ = in[1];
    from_ = out[0];
    if (code != 0) {
        process_ = -1;
        refuse("'" + program + "' cannot be run: " + std::strerror(code));
    }
}

/// Closed pipes ask it to end. What has not ended by then is killed, with all processes that it has started.
Browser::~Browser()
{
    if (to_ >= 0) ::close(to_);
    if (from_ >= 0) ::close(from_);
    if (process_ > 0) {
        const Clock::time_point begin = Clock::now();
        while (::waitpid(process_, nullptr, WNOHANG) == 0 && Clock::now() - begin < farewell)
            std::this_thread::sleep_for(std::chrono::milliseconds(slice));
        ::kill(-process_, SIGKILL);
        ::waitpid(process_, nullptr, WNOHANG);
    }
    std::error_code error;
    fs::remove_all(folder_, error);
}

void Browser::refuse(const std::string& why) const
{
    throw IoError("the browser that draws pictures failed: " + why, fault);
}

void Browser::refuse_ended() const
{
    std::ifstream told(folder_ / "told");
    std::string line, last;
    while (std::getline(told, line))
        if (!line.empty()) last = line;
    refuse("it has ended" + (last.empty() ? "" : " (" + last + ")"));
}

void Browser::send(std::string_view message)
{
    while (!message.empty()) {
        const ssize_t n = ::send(to_, message.data(), message.size(), MSG_NOSIGNAL);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) refuse_ended();
        message.remove_prefix(static_cast<std::size_t>(n));
    }
}

std::string Browser::receive()
{
    std::size_t looked = 0;
    for (;;) {
        if (const std::size_t end = unread_.find('\0', looked); end != std::string::npos) {
            std::string message = unread_.substr(0, end);
            unread_.erase(0, end + 1);
            return message;
        }
        looked = unread_.size();
        pollfd wanted{from_, POLLIN, 0};
        const int n_ready = ::poll(&wanted, 1, slice);
        Patience::ask();
        if (n_ready <= 0) continue;
        std::array<char, 1 << 16> buffer{};
        const ssize_t n = ::read(from_, buffer.data(), buffer.size());
        if (n == 0) refuse_ended();
        if (n > 0) unread_.append(buffer.data(), static_cast<std::size_t>(n));
    }
}

/// A reply begins with the number of its command; messages with another beginning are events, which nobody
/// waits for.
std::string Browser::answer(const std::string& method, const std::string& parameters)
{
    const std::string id = "{\"id\":" + std::to_string(++number_) + ",";
    std::string message = id + "\"method\":\"" + method + "\",\"params\":" + parameters;
    if (!session_.empty()) message += ",\"sessionId\":\"" + session_ + "\"";
    message += "}";
    message += '\0';
    send(message);
    for (;;) {   // events come between
        std::string reply = receive();
        if (!reply.starts_with(id)) continue;
        if (reply.starts_with(id + "\"error\"")) refuse(string_member(reply, "message"));
        return reply;
    }
}

void Browser::open(const std::string& page)
{
    const fs::path file = folder_ / "page.html";
    std::ofstream(file, std::ios::binary) << page;
    const std::string target =
        string_member(answer("Target.createTarget", R"({"url":"about:blank"})"), "targetId");
    session_ = string_member(
        answer("Target.attachToTarget", R"({"targetId":")" + target + R"(","flatten":true})"), "sessionId");
    JsonWriter json;
    json.begin_object().member("url", "file://" + file.string()).end_object();
    answer("Page.navigate", json.text());
    const Clock::time_point begin = Clock::now();
    while (evaluate("String(document.readyState === 'complete' && 'livensReport' in window)") != "true") {
        if (Clock::now() - begin > patience_of_pages) refuse("the page does not begin");
        std::this_thread::sleep_for(std::chrono::milliseconds(slice));
    }
}

std::string Browser::evaluate(const std::string& expression)
{
    JsonWriter json;
    json.begin_object().member("expression", expression);
    json.member("awaitPromise", true).member("returnByValue", true).end_object();
    const std::string reply = answer("Runtime.evaluate", json.text());
    if (const std::size_t thrown = reply.find("\"exceptionDetails\""); thrown != std::string::npos) {
        std::string why = string_member(std::string_view(reply).substr(thrown), "description");
        why = why.substr(0, why.find('\n'));
        refuse(why.starts_with("Error: ") ? why.substr(7) : why);
    }
    return string_member(reply, "value");
}

}   // namespace livens
