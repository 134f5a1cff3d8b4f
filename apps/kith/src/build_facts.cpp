#include "build_facts.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <vector>

#include "kith/core/text.hpp"
#include "kith_build_info.hpp"

namespace kith::cli {
namespace {

// What was typed, as the system remembers it.
std::vector<std::string> command_line() {
  std::ifstream file{"/proc/self/cmdline", std::ios::binary};
  const std::string all{std::istreambuf_iterator<char>{file}, {}};
  std::vector<std::string> words;
  for (std::size_t i = 0; i < all.size();) {
    const auto end = std::min(all.find('\0', i), all.size());
    words.push_back(all.substr(i, end - i));
    i = end + 1;
  }
  return words;
}

std::string quoted(const std::string& word) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./,:=+-@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string text{"'"};
  for (const char c : word) text += c == '\'' ? std::string{"'\\''"} : std::string{c};
  return text + "'";
}

}  // namespace

RunFacts facts_of_build() {
  RunFacts facts;
  facts.version = build_info::kVersion;
  facts.git = build_info::kGitId;
  facts.dirty = build_info::kGitDirty;
  facts.compiler = build_info::kCompiler;
  facts.build_type = build_info::kBuildType;
  facts.flags = build_info::kFlags;
  facts.command_line = command_line();
  return facts;
}

std::string program_name() {
  return fmt::format("{} ({}{})", build_info::kVersion, build_info::kGitId, build_info::kGitDirty ? ", modified" : "");
}

std::string utc_now() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

std::string shell_line() { return joined(command_line(), " ", quoted); }

}  // namespace kith::cli
