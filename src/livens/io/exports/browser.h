// SPDX-License-Identifier: BSD-3-Clause
// A browser without a window, for what a page can draw and nothing else can.
#pragma once

#include <filesystem>
#include <string>

#include <sys/types.h>

namespace livens::inline io_internal {

/// Chromium or a relative of it, in a process of its own and with a profile of its own, told what to do
/// through two pipes (the DevTools protocol). It and its folder are gone at the end.
class Browser {
public:
    /// Throws IoError (`browser-missing`) where there is none.
    Browser();
    ~Browser();
    Browser(const Browser&) = delete;
    Browser& operator=(const Browser&) = delete;

    /// Loads a page from its text. Throws IoError (`browser`).
    void open(const std::string& page);
    /// What an expression of the page comes to, a text, or promises. Throws IoError (`browser`) with what was
    /// thrown there, and Stopped.
    std::string evaluate(const std::string& expression);

private:
    void start(const std::string& program);
    /// Its answer to a command, JSON.
    std::string answer(const std::string& method, const std::string& parameters);
    void send(std::string_view message);
    std::string receive();
    [[noreturn]] void refuse(const std::string& why) const;
    [[noreturn]] void refuse_ended() const;   // with its last words

    std::filesystem::path folder_;
    pid_t process_ = -1;
    int to_ = -1, from_ = -1;   // ends of pipes
    int number_ = 0;            // of the last command
    std::string session_;
    std::string unread_;
};

/// The program of a browser: what the variable CHROMIUM says, or the first one of known names that is found;
/// empty: none.
std::string browser_program();

/// A member of an object of JSON whose value is a string, wherever it first stands.
std::string string_member(std::string_view json, std::string_view key);

/// Bytes of base64 (RFC 4648), as browsers write it.
std::string from_base64(std::string_view text);

}   // namespace livens::inline io_internal
