#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <thread>

#include "command.hpp"
#include "exit_codes.hpp"
#include "kith/core/error.hpp"
#include "kith/runs/journal.hpp"
#include "kith/study/study_file.hpp"
#include "kith/study/tables.hpp"
#include "kith_build_info.hpp"
#include "mpi_ranks.hpp"

namespace kith::cli {
namespace {

enum class Health { kGood, kWarning, kBad };

struct Checkup {
  std::string name;
  Health health = Health::kGood;
  std::string text;
};

Checkup check_build() {
  return {
      "version", Health::kGood,
      fmt::format("{} ({}), {}, Eigen {}.{}.{}, nlohmann-json {}.{}.{}, fmt {}.{}.{}, CLI11 {}, SQLite {}, MPI {}",
                  build_info::kVersion, build_info::kGitId, build_info::kCompiler, EIGEN_WORLD_VERSION,
                  EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION, NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                  NLOHMANN_JSON_VERSION_PATCH, FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100,
                  CLI11_VERSION, journal_library_version(), mpi_version())};
}

Checkup check_processor() {
  std::string features;
#if defined(__x86_64__)
  __builtin_cpu_init();
  const bool good = __builtin_cpu_supports("sse4.2") != 0 && __builtin_cpu_supports("popcnt") != 0;
  if (__builtin_cpu_supports("avx2") != 0) features += ", AVX2";
  if (__builtin_cpu_supports("avx512f") != 0) features += ", AVX-512";
  features = (good ? "x86-64-v2" : "older than x86-64-v2") + features;
#else
  const bool good = true;
  features = "not x86-64";
#endif
  return {"processor", good ? Health::kGood : Health::kBad,
          fmt::format("{} threads, {}", std::thread::hardware_concurrency(), features)};
}

// A file in the working directory, removed again.
class ScratchFile {
 public:
  ScratchFile() : path_{".kith-doctor-XXXXXX"}, descriptor_{mkstemp(path_.data())} {}
  ~ScratchFile() {
    if (descriptor_ < 0) return;
    close(descriptor_);
    unlink(path_.c_str());
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }

 private:
  std::string path_;
  int descriptor_;
};

Checkup check_file_system() {
  const ScratchFile file;
  if (file.descriptor() < 0) return {"file system", Health::kWarning, "the working directory cannot be written to"};
  const bool synchronises = write(file.descriptor(), "kith", 4) == 4 && fsync(file.descriptor()) == 0;
  const bool locks = flock(file.descriptor(), LOCK_EX | LOCK_NB) == 0;
  return {"file system", synchronises && locks ? Health::kGood : Health::kWarning,
          fmt::format("fsync {}, flock {} in the working directory", synchronises ? "works" : "fails",
                      locks ? "works" : "fails")};
}

Checkup check_space() {
  struct statvfs facts = {};
  if (statvfs(".", &facts) != 0) return {"free space", Health::kWarning, "unknown"};
  const double megabytes = static_cast<double>(facts.f_bavail) * static_cast<double>(facts.f_frsize) / 1e6;
  constexpr double kEnough = 100.0;
  return {"free space", megabytes < kEnough ? Health::kWarning : Health::kGood,
          fmt::format("{:.0f} MB in the working directory", megabytes)};
}

std::string tables_of(const Atlas& atlas, const Study& study, std::size_t threads) {
  const auto result = run_teams(atlas, study, team_addresses(study), {.threads = threads, .on_progress = {}});
  std::string all;
  write_study_tables(study, result.teams,
                     [&](std::string_view file, std::string_view piece) { all.append(file).append(piece); });
  return all;
}

// The same small study, on one thread and on two: the bytes must not differ.
Checkup check_self() {
  const auto reading = load_study("quick");
  if (!reading.study) throw Error{reading.diagnostics};
  const Atlas atlas{*reading.domain};
  const bool same = tables_of(atlas, *reading.study, 1) == tables_of(atlas, *reading.study, 2);
  return {"self-test", same ? Health::kGood : Health::kBad,
          same ? "a small study on one thread and on two gives the same tables" : "two runs of the same study differ"};
}

const char* word_of(Health health) {
  return health == Health::kGood ? "ok" : health == Health::kWarning ? "warning" : "failed";
}

int run_doctor(Console& console) {
  const std::vector<Checkup> checkups{check_build(), check_processor(), check_file_system(), check_space(),
                                      check_self()};
  bool good = true;
  TextTable table{"lll"};
  for (const auto& checkup : checkups) {
    good = good && checkup.health != Health::kBad;
    table.add({word_of(checkup.health), checkup.name, checkup.text});
  }
  console.print(table.text(console, false));
  return good ? 0 : exit_code(ErrorKind::kMismatch);
}

}  // namespace

void add_doctor(Commands& commands) {
  commands.add("doctor", "Check that this machine can run kith", {"kith doctor"}, run_doctor);
}

}  // namespace kith::cli
