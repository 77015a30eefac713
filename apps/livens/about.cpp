// What the program knows about itself: schema, explanations, version.
#include "commands.h"
#include "console.h"
#include "failure.h"
#include "livens/base/version.h"
#include "livens/io/results.h"

namespace livens::program {

namespace {

std::string with_end(std::string text)
{
    if (!text.ends_with('\n')) text += '\n';
    return text;
}

}   // namespace

int schema_command(bool markdown)
{
    print(with_end(markdown ? schema_markdown() : schema_json()));
    return exit_ok;
}

int explain_command(const std::string& code)
{
    std::string text;
    if (code.empty()) {
        for (const std::string_view known : diagnostic_codes()) text += std::string(known) + "\n";
    } else {
        text = explain(code);
        if (text.empty())
            throw failure(exit_usage, "there is no code '" + code + "'; 'livens explain' alone lists all");
    }
    print(with_end(text));
    return exit_ok;
}

int version_command(const Common& common)
{
    if (!common.json) {
        print(std::string("livens ") + version + "\n");
        return exit_ok;
    }
    JsonWriter json(2);
    json.begin_object().member("version", version);
    json.member("format", format_major).member("format_minor", format_minor).end_object();
    print(json.text() + "\n");
    return exit_ok;
}

}   // namespace livens::program
