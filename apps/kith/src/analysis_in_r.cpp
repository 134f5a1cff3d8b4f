#include "analysis_in_r.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>

#include "embedded.hpp"
#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/files/temporary_folder.hpp"

namespace kith::cli {
namespace {

// Runs `Rscript --vanilla analysis.R data.csv plan.json > out 2> err` in a folder; false if there is no such program.
bool run_r_script(const std::filesystem::path& folder) {
  constexpr int kNewFile = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, (folder / "out").c_str(), kNewFile, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, (folder / "err").c_str(), kNewFile, 0600);
  std::array<std::string, 5> words{"Rscript", "--vanilla", folder / "analysis.R", folder / "data.csv",
                                   folder / "plan.json"};
  std::array<char*, 6> arguments{};
  for (std::size_t i = 0; i < words.size(); ++i) arguments.at(i) = words.at(i).data();
  pid_t child = 0;
  const int failed = posix_spawnp(&child, words.front().c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed == ENOENT || failed == EACCES) return false;
  if (failed != 0) throw Error{ErrorKind::kIo, "Rscript cannot be started"};
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return true;
}

// The last line that R wrote, which says why it stopped.
std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

}  // namespace

std::optional<Analysis> analyze_in_r(const Dataset& data, const ModelQuestion& question,
                                     const AnalysisOptions& options) {
  const TemporaryFolder scratch{"kith-analysis"};
  const auto& folder = scratch.path();
  write_file_atomically(folder / "analysis.R", detail::kAnalysisScript);
  write_file_atomically(folder / "data.csv", table_csv(data));
  write_file_atomically(folder / "plan.json", table_plan(data, question, options));
  if (!run_r_script(folder)) return std::nullopt;
  const auto printed = read_file(folder / "out");
  if (printed.empty()) {
    throw Error{ErrorKind::kInfeasible, "R cannot analyse the table: " + last_line(read_file(folder / "err")),
                Advice{std::string{"install what is missing: "} + kInstallR}};
  }
  return read_table_findings(printed, data.file());
}

std::optional<Analysis> analyze_in_r_or_alone(const Dataset& data, const ModelQuestion& question,
                                              const AnalysisOptions& options) {
  auto analysis = analyze_in_r(data, question, options);
  if (analysis) return analysis;
  analysis = analyze_balanced_table(data, question, options);
  if (analysis) {
    analysis->notes.push_back(
        std::string{"R is not installed, so this is only the analysis of variance that kith has of its own; for mixed "
                    "models, ratings, counts and covariates: "} +
        kInstallR);
  }
  return analysis;
}

}  // namespace kith::cli
