// SPDX-License-Identifier: BSD-3-Clause
// libFuzzer's target for URDFs; fuzz.cmake says how it is built and run.
#include "fuzz/urdf.h"

#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    if (!livens::test::is_answered_as_urdf(std::string(reinterpret_cast<const char*>(data), size)))
        std::abort();
    return 0;
}
