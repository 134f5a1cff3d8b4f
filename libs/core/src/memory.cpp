#include "kith/core/memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

#include "kith/core/error.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

// The number after `key` in a file of lines "KEY NUMBER"; without a key the number that the file begins with.
std::optional<std::uint64_t> number_in(const fs::path& path, const std::string& key = {}) {
  std::ifstream file{path};
  for (std::string line; std::getline(file, line);) {
    std::istringstream words{line};
    std::string name;
    std::uint64_t number = 0;
    if (!key.empty() && (!(words >> name) || name != key)) continue;
    if (words >> number) return number;
    return std::nullopt;
  }
  return std::nullopt;
}

std::uint64_t left(std::uint64_t limit, std::uint64_t used) { return limit > used ? limit - used : 0; }

std::uint64_t free_on_machine(const fs::path& root) {
  const auto kilobytes = number_in(root / "proc/meminfo", "MemAvailable:");
  return kilobytes ? *kilobytes * 1024 : kUnlimited;
}

// What one control group leaves. Cached files that nobody uses can be dropped at any time.
std::uint64_t free_in_group(const fs::path& group, const char* limit_file, const char* usage_file,
                            const char* droppable_key) {
  const auto limit = number_in(group / limit_file);
  const auto used = number_in(group / usage_file);
  if (!limit || !used) return kUnlimited;  // "max", or no such group
  const auto droppable = number_in(group / "memory.stat", droppable_key).value_or(0);
  return left(*limit, left(*used, droppable));
}

// The group itself and all that it is in. Within a container its path may be that of the machine outside, of which
// only the root can be seen.
std::uint64_t free_in_groups(const fs::path& root) {
  std::uint64_t least = kUnlimited;
  std::ifstream file{root / "proc/self/cgroup"};
  for (std::string line; std::getline(file, line);) {  // "0::/a/b", or "9:memory:/a/b" of version 1
    const auto first = line.find(':');
    const auto second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const auto controllers = line.substr(first + 1, second - first - 1);
    const bool is_new = controllers.empty();
    if (!is_new && ("," + controllers + ",").find(",memory,") == std::string::npos) continue;
    const auto top = is_new ? root / "sys/fs/cgroup" : root / "sys/fs/cgroup/memory";
    for (fs::path group = fs::path{line.substr(second + 1)}.relative_path();; group = group.parent_path()) {
      const auto here =
          is_new ? free_in_group(top / group, "memory.max", "memory.current", "inactive_file")
                 : free_in_group(top / group, "memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file");
      least = std::min(least, here);
      if (group.empty()) break;
    }
  }
  return least;
}

std::uint64_t free_of_limit(int resource, std::uint64_t used) {
  rlimit limit = {};
  if (getrlimit(static_cast<__rlimit_resource>(resource), &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return kUnlimited;
  return left(limit.rlim_cur, used);
}

// The address space and the data of this process, as ulimit -v and -d count them.
std::uint64_t free_in_limits(const fs::path& root) {
  const auto status = root / "proc/self/status";
  return std::min(free_of_limit(RLIMIT_AS, number_in(status, "VmSize:").value_or(0) * 1024),
                  free_of_limit(RLIMIT_DATA, number_in(status, "VmData:").value_or(0) * 1024));
}

std::uint64_t memory_of_text(const std::string& text) {
  std::uint64_t number = 0;
  const auto* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, number);
  constexpr std::string_view kUnits = "MGT";
  const auto unit = stopped != end ? kUnits.find(*stopped) : std::string_view::npos;
  constexpr std::uint64_t kMost = 1'000'000;
  if (error != std::errc{} || stopped + 1 != end || unit == std::string_view::npos || number > kMost) {
    throw Error{ErrorKind::kUsage,
                "the environment variable KITH_MEMORY must be like 500M, 8G or 1T, not '" + text + "'"};
  }
  return number << (20 + 10 * unit);
}

}  // namespace

std::uint64_t free_memory(const fs::path& root) {
  if (const char* const said = std::getenv("KITH_MEMORY"); said != nullptr && *said != '\0') {
    return left(memory_of_text(said), number_in(root / "proc/self/status", "VmRSS:").value_or(0) * 1024);
  }
  return std::min({free_on_machine(root), free_in_groups(root), free_in_limits(root)});
}

std::string memory_text(std::uint64_t bytes) {
  const bool is_large = bytes >= 1'000'000'000;
  const double amount = static_cast<double>(bytes) / (is_large ? 1e9 : 1e6);
  const double step = amount >= 100.0 ? 10.0 : amount >= 10.0 || !is_large ? 1.0 : 0.1;
  std::ostringstream text;
  text << std::max(std::round(amount / step) * step, is_large ? 1.0 : 0.0) << (is_large ? " GB" : " MB");
  return text.str();
}

void require_memory(std::uint64_t bytes, const std::string& what, const std::string& hint) {
  const auto there = free_memory();
  if (bytes <= there) return;
  const auto message = what + " needs about " + memory_text(bytes) + " of memory; " + memory_text(there) + " are free";
  Diagnostic diagnostic;
  diagnostic.id = "E1201";
  diagnostic.message = message;
  diagnostic.hint = hint;
  diagnostic.infeasible = true;
  throw Error{ErrorKind::kInfeasible, message, {diagnostic}};
}

void MemoryGuard::check() {
  require_memory(unchecked_, what_, hint_);
  unchecked_ = 0;
}

}  // namespace kith
