#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace kith::faults {

/// The calls that a fault can strike; variants of a call (pwrite64, renameat2) count as one kind.
enum class Kind : std::uint8_t {
  kWrite,
  kPwrite,
  kPwritev,
  kWritev,
  kFsync,
  kFdatasync,
  kRename,
  kLink,
  kUnlink,
  kRmdir,
  kMkdir,
  kOpen,  ///< With O_CREAT or O_TMPFILE only.
  kFtruncate,
  kFallocate,
  kClose,
  kAny,  ///< In a plan: every kind.
};
inline constexpr std::size_t kNumKinds = static_cast<std::size_t>(Kind::kAny);

/// What becomes of a call.
enum class Action : std::uint8_t {
  kNone,       ///< It is made.
  kKill,       ///< The process is killed before it.
  kKillAfter,  ///< The process is killed after it.
  kFail,       ///< It is not made and fails with the plan's error.
  kShort,      ///< Half of the bytes are written.
  kTorn,       ///< Half of the bytes are written, then the process is killed.
};

/// The fault that the environment asks for, and the calls counted so far. One per process; all of it is thread-safe and
/// allocates nothing.
class Plan {
 public:
  /// Reads KITH_FAULT, KITH_FAULT_ROOT, KITH_FAULT_COUNT and KITH_FAULT_RANK.
  Plan() noexcept;

  [[nodiscard]] bool concerns_path(const char* path) const noexcept;
  /// Whether the path, relative to an open folder or AT_FDCWD, is below the root.
  [[nodiscard]] bool concerns_path_at(int folder, const char* path) const noexcept;
  [[nodiscard]] bool concerns_descriptor(int descriptor) const noexcept;

  /// Counts a call below the root and says what becomes of it. `grows` says whether it needs space on the disk.
  [[nodiscard]] Action count(Kind kind, bool grows) noexcept;
  [[nodiscard]] int error() const noexcept { return full_.load() ? full_error() : error_; }

  /// Appends the counts to the file of KITH_FAULT_COUNT, a line per kind.
  void write_counts() const noexcept;
  [[noreturn]] static void kill_process() noexcept;

 private:
  [[nodiscard]] static int full_error() noexcept;
  [[nodiscard]] bool is_below_root(const char* path, std::size_t length) const noexcept;
  void parse_fault(std::string_view text) noexcept;
  void note_strike(Kind kind) const noexcept;
  void append(const char* text, std::size_t length) const noexcept;

  const char* root_ = nullptr;
  std::size_t root_length_ = 0;
  const char* count_file_ = nullptr;
  Kind kind_ = Kind::kAny;
  std::uint64_t number_ = 0;  // 0: no fault
  Action action_ = Action::kNone;
  int error_ = 0;
  bool fills_disk_ = false;
  std::atomic<bool> full_{false};
  std::atomic<std::uint64_t> matching_{0};
  std::atomic<std::uint64_t> counts_[kNumKinds] = {};
};

}  // namespace kith::faults
