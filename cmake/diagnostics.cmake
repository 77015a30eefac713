# SPDX-License-Identifier: BSD-3-Clause
# The pages of `livens explain` are docs/diagnostics.md itself, compiled in.

set(diagnostics_file ${PROJECT_SOURCE_DIR}/docs/diagnostics.md)
set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${diagnostics_file})
file(READ ${diagnostics_file} diagnostics_page)
# A literal a page: compilers need not take one of more than 65536 characters.
string(REPLACE "\n## " ")livens\",\n        R\"livens(\n## " diagnostics_page "${diagnostics_page}")
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/diagnostics_page.cpp @ONLY CONTENT
"#include \"livens/io/scenario/schema/explain.h\"

#include <string>

std::string_view livens::diagnostics_markdown()
{
    static const std::string all = [] {
        std::string text;
        for (const char* page : {R\"livens(@diagnostics_page@)livens\"}) text += page;
        return text;
    }();
    return all;
}
")
target_sources(livens_room_io PRIVATE ${PROJECT_BINARY_DIR}/generated/diagnostics_page.cpp)
