#include <fmt/format.h>

#include "command.hpp"
#include "kith_build_info.hpp"

namespace kith::cli {
namespace {

int run_version(Console& console) {
  using namespace build_info;  // NOLINT(google-build-using-namespace): constants only
  console.print(
      fmt::format("kith {} ({}{}, {}, {})\n", kVersion, kGitId, kGitDirty ? ", changed" : "", kCompiler, kBuildType));
  return 0;
}

}  // namespace

void add_version(Commands& commands) {
  commands.add("version", "Print version, commit and compiler (also: kith --version)", {"kith --version"}, run_version);
}

}  // namespace kith::cli
