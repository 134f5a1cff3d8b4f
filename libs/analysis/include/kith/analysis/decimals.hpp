#pragma once

#include <span>
#include <string>

// How many decimals numbers are printed with.
namespace kith {

/// The fewest decimals from `least` with which the ends of an interval read differently, if they differ, and one that
/// does not contain 0 reads so.
[[nodiscard]] int interval_decimals(double low, double high, int least);
/// "[0.21, 0.43]", with interval_decimals().
[[nodiscard]] std::string interval_text(double low, double high, int least);
/// The fewest decimals from `least` with which shares read differently, if they differ, and none reads as 0 or 1 that
/// is neither.
[[nodiscard]] int share_decimals(std::span<const double> shares, int least);
/// With so many decimals, and never as "-0.00".
[[nodiscard]] std::string fixed_text(double value, int decimals);

}  // namespace kith
