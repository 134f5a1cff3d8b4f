#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "kith/core/error.hpp"

namespace kith::cli {

/// Why the text is no integer of this range ("must be an integer from 1 to 9, not 'x'"), or nothing.
[[nodiscard]] std::string wrong_integer(const std::string& text, std::int64_t min,
                                        std::int64_t max = std::numeric_limits<std::int64_t>::max());

/// "2/7" as {2, 7}, or nothing if it is no part of a whole.
[[nodiscard]] std::optional<ShardOption> shard_of(const std::string& text);

/// The numbers that an option takes: from `low` to `high`, or only those above `low`.
struct NumberRange {
  enum End { kFrom, kAbove };
  double low = 0.0;
  double high = 1.0;
  End end = kFrom;
};
inline constexpr double kLargestNumber = 1e6;

/// Why the text is no number of this range ("must be a number from 0 to 1, not '2'"), or nothing. What counts is the
/// value: "1", "1.0" and "1e0" are the same.
[[nodiscard]] std::string wrong_number(const std::string& text, const NumberRange& range);

/// Why the text is none of the words; behind a line break the nearest of them. Or nothing.
[[nodiscard]] std::string wrong_word(const std::string& text, const std::vector<std::string>& words);

/// For options that do not go together, or that name what does not exist. @throws kith::Error (kUsage).
[[noreturn]] inline void refuse(const std::string& message) { throw Error{ErrorKind::kUsage, message}; }

/// The parser's complaint about the value of an option, or about options that do or do not go together, in plain
/// words. Names the environment variable if the value came from one.
[[nodiscard]] UsageError explain_value(const CommandDescription& command, const std::string& complaint,
                                       const std::vector<std::string>& arguments);

}  // namespace kith::cli
