// SPDX-License-Identifier: BSD-3-Clause
// Where words go: data to standard output, everything else to standard error.
#pragma once

#include <string>
#include <string_view>

namespace livens::program {

/// Standard output cannot take the data: a full disk, a closed pipe.
struct OutputError {
    std::string message;
};

/// All of `text` to standard output, at once and without a buffer. Throws OutputError.
void print(std::string_view text);

/// Lines on standard error with the program's name before them. They are said in turn, from one thread.
enum class Verbosity { quiet, normal, verbose };
void set_verbosity(Verbosity verbosity);
void say_error(std::string_view message);
void say_warning(std::string_view message);
void say_note(std::string_view message);     ///< not with --quiet
void say_detail(std::string_view message);   ///< with --verbose alone
/// Text as it is, without the program's name: diagnostics that have their own layout.
void say_raw(std::string_view text);

bool error_is_terminal();
bool output_is_terminal();

/// Text without what is_invisible(), so that a name in a file steers no terminal and deceives no eye.
std::string plain(std::string_view text);

}   // namespace livens::program
