#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace kith {

/// Bytes that this process may still take: the least of what the machine has available (MemAvailable), what its
/// control groups leave (versions 1 and 2) and what its own limits leave (ulimit -v, ulimit -d). Where nothing
/// can be found out, the largest number. The environment variable KITH_MEMORY ("500M", "8G", "1T": binary units)
/// takes the place of all of them: what this process may have altogether.
/// @param root  where /proc and /sys are; tests bring their own.
/// @throws kith::Error (kUsage) if KITH_MEMORY is not of this form.
[[nodiscard]] std::uint64_t free_memory(const std::filesystem::path& root = "/");

/// "about 6 GB", "about 300 MB": in units of 10^9 and 10^6 bytes, one digit or two.
[[nodiscard]] std::string memory_text(std::uint64_t bytes);

/// Checks that there is memory for work before it starts.
/// @param bytes  how much it is expected to need.
/// @param what   the work, as the subject of a sentence: "planning 90000 states".
/// @param hint   what would need less.
/// @throws kith::Error (kInfeasible, E1201) if more is needed than free_memory().
void require_memory(std::uint64_t bytes, const std::string& what, const std::string& hint);

/// Counts what a computation has taken whose needs are not known beforehand, and ends it before the machine runs out.
class MemoryGuard {
 public:
  /// As of require_memory().
  MemoryGuard(std::string what, std::string hint) : what_{std::move(what)}, hint_{std::move(hint)} {}

  /// So many bytes are about to be taken. @throws kith::Error as require_memory() does.
  void take(std::uint64_t bytes) {
    unchecked_ += bytes;
    if (unchecked_ >= kStep) check();
  }

 private:
  static constexpr std::uint64_t kStep = std::uint64_t{64} << 20U;  // looking takes some 50 us

  void check();

  std::string what_;
  std::string hint_;
  std::uint64_t unchecked_ = 0;
};

}  // namespace kith
