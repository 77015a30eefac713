// SPDX-License-Identifier: BSD-3-Clause
// How a stream shows words: colours, signs, width. Files and pipes get plain ASCII words on lines of any
// length.
#pragma once

#include <string>
#include <string_view>

namespace livens::program {

/// What --color says.
enum class Colour { automatic, always, never };
void set_colour(Colour colour);

struct Terminal {
    bool colour = false;
    bool signs = false;   ///< beyond ASCII
    int columns = 0;      ///< 0: lines of any length
};

/// Of a file descriptor, asked anew at every call: windows change their size.
///
/// colour   --color; automatic: a terminal, NO_COLOR empty or not set, TERM not "dumb"
/// signs    a terminal (or --color always) and a locale in UTF-8
/// columns  COLUMNS, else what the terminal says, else 80; 0 for what is no terminal, unless COLUMNS is set
Terminal terminal_of(int descriptor);

enum class Ink { good, doubtful, bad, dim, strong };

/// `text` in this ink, if the terminal has colours.
std::string painted(const Terminal& terminal, Ink ink, std::string_view text);

/// Columns that a text takes, one for each code point.
int width_of(std::string_view text);

/// `text` broken at spaces so that no line is longer than `columns` (0: any), but for words that are longer
/// themselves. `used` columns of the first line are taken; later lines begin with `indent` spaces.
std::string wrapped(std::string_view text, int columns, int indent, int used);

}   // namespace livens::program
