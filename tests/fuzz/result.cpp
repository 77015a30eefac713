// SPDX-License-Identifier: BSD-3-Clause
// libFuzzer's target for result files, without their checksums, which would keep it out; fuzz.cmake says how
// it is run.
#include "fuzz/result.h"

#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    livens::test::answer_to(std::string(reinterpret_cast<const char*>(data), size), false);
    return 0;
}
