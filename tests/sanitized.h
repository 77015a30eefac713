// SPDX-License-Identifier: BSD-3-Clause
// Whether this is a build with the address sanitizer: GCC says so by a macro, Clang by a feature.
#pragma once

#if defined(__SANITIZE_ADDRESS__)
#define LIVENS_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define LIVENS_SANITIZED 1
#endif
#endif

namespace livens {

#ifdef LIVENS_SANITIZED
constexpr bool is_sanitized = true;
#else
constexpr bool is_sanitized = false;
#endif

/// What a test says that is left to the release build: a study of many whole motions.
constexpr const char* study = "a study of whole motions, which the release build has";

}   // namespace livens
