// SPDX-License-Identifier: BSD-3-Clause
// libFuzzer's target for result files whose headers lie and whose checksums fit; fuzz.cmake says how it is
// run.
#include "fuzz/edits.h"
#include "fuzz/result.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const std::vector<std::string> files = livens::test::result_files();
    const std::string_view program(reinterpret_cast<const char*>(data), size);
    livens::test::answer_to(livens::test::Edits(program, files).bytes(), true);
    return 0;
}
