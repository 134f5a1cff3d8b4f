#include <fmt/format.h>
#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "command.hpp"
#include "kith/present/json.hpp"
#include "kith/runs/journal.hpp"
#include "kith_build_info.hpp"
#include "libraries.hpp"
#include "mpi_ranks.hpp"

namespace kith::cli {

std::vector<Library> library_versions() {
  return {{"Eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"nlohmann-json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                        NLOHMANN_JSON_VERSION_PATCH)},
          {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
          {"CLI11", CLI11_VERSION},
          {"SQLite", journal_library_version()},
          {"MPI", mpi_version()}};
}

int run_version(const NoOptions& /*options*/, Console& console) {
  using namespace build_info;  // NOLINT(google-build-using-namespace): constants only
  if (!console.json()) {
    console.print(
        fmt::format("kith {} ({}{}, {}, {})\n", kVersion, kGitId, kGitDirty ? ", changed" : "", kCompiler, kBuildType));
    return 0;
  }
  Json libraries = Json::object();
  for (const auto& library : library_versions()) libraries[library.name] = library.version;
  console.print_json(Json{{"schema", "kith.version/1"},
                          {"version", kVersion},
                          {"git", kGitId},
                          {"dirty", kGitDirty},
                          {"compiler", kCompiler},
                          {"build_type", kBuildType},
                          {"flags", kFlags},
                          {"libraries", libraries}});
  return 0;
}

void add_version(Commands& commands) {
  commands.add<NoOptions>(
      "version", "Print version, commit and compiler (also: kith --version)",
      {"kith --version", "kith --version --json"}, [](OptionList& list, NoOptions&) { list.json(); }, run_version);
}

}  // namespace kith::cli
