// SPDX-License-Identifier: BSD-3-Clause
// libFuzzer's target for scenarios; fuzz.cmake says how it is built and run.
#include "fuzz/scenario.h"

#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    if (!livens::test::is_answered(std::string(reinterpret_cast<const char*>(data), size))) std::abort();
    return 0;
}
