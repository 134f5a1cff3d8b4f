#pragma once

#include <string>

namespace kith {

/// The mathematical library, such as "glibc 2.36".
[[nodiscard]] std::string math_library();

/// What the last bits of results depend on besides the program: 16 hexadecimal digits that differ where exp, log, sin
/// and the like of two machines differ in any of some thousand places (glibc chooses them by the processor's abilities,
/// such as fused multiply-add). Equal digits, equal bits.
[[nodiscard]] std::string arithmetic_fingerprint();

}  // namespace kith
