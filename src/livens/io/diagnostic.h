// SPDX-License-Identifier: BSD-3-Clause
// Messages about a file: what rustc would print.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace [[gnu::visibility("default")]] livens {

enum class Severity { error, warning };

/// One finding in a file. Line and column count from 1; 0 means the whole file.
struct Diagnostic {
    Severity severity = Severity::error;
    std::string code;   ///< stable, listed in docs/diagnostics.md: "unknown-key"
    std::string message;
    std::string file;
    int line = 0;
    int column = 0;
    int length = 1;              ///< characters to underline
    std::string note;            ///< the law that is broken; may be empty
    std::string help;            ///< the likely fix; may be empty
    std::string source_line{};   ///< of a file that another one includes: the line itself
};

enum class DiagnosticFormat { human, json, gnu };

/// All findings as text; `source` is the file's text and serves to show lines. Control characters and invalid
/// UTF-8 from the file are escaped. json: one array; gnu: file:line:column: error: message [code].
/// `columns`: lines of the file are cut to so many, 0: to 120.
std::string render(const std::vector<Diagnostic>& diagnostics, std::string_view source,
                   DiagnosticFormat format, bool colour = false, int columns = 0);

/// The page of a code (`livens explain CODE`), and all codes; an empty page for an unknown one.
std::string_view explain(std::string_view code);
std::vector<std::string_view> diagnostic_codes();

}   // namespace gnu::visibility("default")]]livens
