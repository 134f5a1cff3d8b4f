#include "trial.hpp"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "damage.hpp"
#include "kith/core/error.hpp"
#include "kith/core/stream.hpp"
#include "kith/files/atomic_file.hpp"
#include "process.hpp"
#include "readers.hpp"
#include "recovery.hpp"

namespace kith::faults {
namespace {

namespace fs = std::filesystem;

const Preparation& preparation_of(const Scenario& scenario, const Variant& variant) {
  return scenario.preparations[static_cast<std::size_t>(variant.preparation) % scenario.preparations.size()];
}

// What is in the folder "run" in the end.
const Expected& expected_of(const Scenario& scenario, const Models& models) {
  return scenario.commands.back().front() == "merge" ? *models.expected_of("merged") : models.expected();
}

// What the folder "run" may be found to hold before the command is through: what was there, or what comes.
std::vector<const Expected*> allowed_in(const Scenario& scenario, const Variant& variant, const Models& models) {
  std::vector<const Expected*> allowed{&expected_of(scenario, models)};
  for (const auto& [model, name] : preparation_of(scenario, variant).placed) {
    const auto* const before = models.expected_of(model);
    if (name == "run" && before != nullptr) allowed.push_back(before);
  }
  return allowed;
}

// Whether what a command of Where::kOutput wrote is what it writes undisturbed.
bool is_as_expected(const Words& command, const Ended& ended, const fs::path& root, const Models& models) {
  if (command.front() == "analyze") return ended.out == models.expected().analysis;
  const auto page = root / "run" / "report.html";
  return fs::exists(page) && without_dates(read_file(page)) == models.expected().page;
}

// Whether every line of `some` is one of `all`, in the same order.
bool has_lines_of(const std::string& all, const std::string& some) {
  std::istringstream wholes{all}, parts{some};
  std::string whole;
  for (std::string part; std::getline(parts, part);) {
    while (std::getline(wholes, whole) && whole != part) {
    }
    if (!wholes) return false;
  }
  return true;
}

class Trial {
 public:
  Trial(const Case& one, const Scenario& scenario, const Models& models, const fs::path& folder)
      : case_{one},
        scenario_{scenario},
        variant_{variant_of(one.variant)},
        models_{models},
        folder_{folder},
        root_{folder / "root"},
        recovery_{scenario, models, root_} {}

  Outcome run() {
    prepare(scenario_, variant_, models_, root_);
    recovery_.look();
    if (scenario_.where == Where::kFolder) {
      damage();
    } else {
      strike();
    }
    if (outcome_.struck) finish();
    return outcome_;
  }

 private:
  void wrong(const std::string& text) { outcome_.wrong += text; }

  void damage() {
    const bool was_finished = fs::exists(root_ / "run" / "manifest.json");
    outcome_.struck = do_damage(case_.family, case_.fault, root_, models_);
    if (!outcome_.struck) return;
    if (fs::exists(root_ / "run")) {
      wrong(wrong_readings(models_, {root_, {&expected_of(scenario_, models_)}, false, was_finished}));
    }
    if (scenario_.name == "shards") merge_as_it_is();
    const auto name = damaged_name(case_.fault);
    // Where a journal is missing altogether, only a finished run shows that there was one.
    const bool is_there = fs::exists(root_ / name) || was_finished;
    if (case_.family != "mix" && fs::path{name}.extension() == ".sqlite" && is_there) recovery_.require_names(name);
  }

  // Shards that are not sound are merged to the right tables, or refused by name.
  void merge_as_it_is() {
    const auto ended = run_kith(models_.tools(), root_, {"merge", "s1", "s2", "s3", "-o", "early"});
    wrong(wrong_ending("merge", ended));
    const auto shard = damaged_name(case_.fault).substr(0, 2);
    if (ended.code == 0 && files_below(root_ / "early" / "tables") != models_.expected().tables) {
      wrong("merge exits with 0 and other tables; ");
    }
    // A shard that is not finished is refused first.
    const bool is_unfinished = variant_.preparation % 2 == 1 && ended.err.find("s1") != std::string::npos;
    if (ended.code != 0 && ended.err.find(shard) == std::string::npos && !is_unfinished) {
      wrong("merge refuses without naming the shard (" + ended.err.substr(0, 300) + "); ");
    }
    if (ended.code != 0) merge_in_part();
    fs::remove_all(root_ / "early");
  }

  // With --allow-partial there may be fewer rows, but none that are wrong, and neither exit code nor manifest is
  // silent.
  void merge_in_part() {
    const auto ended = run_kith(models_.tools(), root_, {"merge", "s1", "s2", "s3", "-o", "early", "--allow-partial"});
    wrong(wrong_ending("merge --allow-partial", ended));
    const auto tables = files_below(root_ / "early" / "tables");
    if (ended.code == 0 && tables != models_.expected().tables) {
      wrong("merge --allow-partial exits with 0 and other tables; ");
    }
    if (ended.code != 6) return;
    for (const auto& [name, text] : tables) {
      const auto whole = models_.expected().tables.find(name);
      if (whole == models_.expected().tables.end() || !has_lines_of(whole->second, text)) {
        wrong("merge --allow-partial writes other rows into " + name + "; ");
      }
    }
    const auto manifest = comparable_manifest(read_file(root_ / "early" / "manifest.json"));
    if (!manifest.contains("missing")) wrong("merge --allow-partial does not say in the manifest what is missing; ");
  }

  void strike() {
    auto command = struck_command(scenario_, variant_, models_, root_);
    const auto counts = folder_ / "counts";
    if (case_.family == "timer") {
      command.kill_after = std::chrono::microseconds{std::strtol(case_.fault.c_str(), nullptr, 10)};
    } else if (case_.family == "failpoint") {
      command.environment.insert(command.environment.begin(), {"KITH_FAILPOINT", case_.fault});
    } else if (case_.family != "none") {
      use_shim(command, scenario_, models_, counts, case_.fault);
    }
    const auto ended = faults::run(command);
    const bool killed = ended.code == kKilled && !ended.hung;
    outcome_.struck = killed || case_.family == "none" ||
                      (fs::exists(counts) && read_file(counts).find("struck") != std::string::npos);
    if (!outcome_.struck && ended.code == 0) return;
    outcome_.struck = true;
    check_struck(ended, killed && case_.family != "io");
  }

  void check_struck(const Ended& ended, bool killed) {
    const auto& words = scenario_.commands.front();
    if (!killed && scenario_.where != Where::kOutput) wrong(wrong_ending("the struck command", ended));
    if (scenario_.where == Where::kOutput) {  // the fault may have struck the message, too
      if (!killed && (ended.code == 1 || ended.code > 8)) wrong("the struck command crashes; ");
      if (ended.code == 0 && !is_as_expected(words, ended, root_, models_)) {
        wrong("the struck command exits with 0 and another result; ");
      }
      return;
    }
    const auto tables = files_below(root_ / "run" / "tables");
    if (ended.code == 0 && scenario_.commands.size() == 1 && tables != models_.expected().tables) {
      wrong("the struck command exits with 0 and other tables; ");
    }
    if (!tables.empty()) {
      wrong(wrong_readings(models_, {root_, allowed_in(scenario_, variant_, models_), true}));
    }
  }

  void finish() {
    if (scenario_.where == Where::kOutput) {
      const auto& words = scenario_.commands.front();
      const auto ended = run_kith(models_.tools(), root_, words);
      outcome_.resumed = ended.code == 0;
      if (ended.code != 0 || !is_as_expected(words, ended, root_, models_)) {
        wrong("the same command, undisturbed, does not do it again; ");
      }
      return;
    }
    const bool may_refuse = scenario_.where == Where::kFolder;
    const auto recovered = recovery_.run(may_refuse, case_.family == "mix", verifies());
    outcome_.resumed = recovered.wrong.empty() && !recovered.refused;
    outcome_.refused = recovered.refused;
    outcome_.lost = recovered.lost;
    wrong(recovered.wrong);
  }

  // Whether verify is asked at the end: always after damage, else in one of three cases.
  [[nodiscard]] bool verifies() const {
    return scenario_.where == Where::kFolder || stream_tag(to_text(case_)) % 3 == 0;
  }

  const Case& case_;
  const Scenario& scenario_;
  Variant variant_;
  const Models& models_;
  fs::path folder_, root_;
  Recovery recovery_;
  Outcome outcome_;
};

}  // namespace

void prepare(const Scenario& scenario, const Variant& variant, const Models& models, const fs::path& root) {
  fs::create_directories(root);
  const auto& preparation = preparation_of(scenario, variant);
  for (const auto& [model, name] : preparation.placed) copy_folder(models.folder(model), root / name);
  if (preparation.damaged.empty()) return;
  const auto& journals = models.damaged_journals(preparation.placed.front().model);
  const auto round = static_cast<std::size_t>(variant.preparation) / scenario.preparations.size();
  write_text(root / preparation.damaged, journals[round % journals.size()]);
}

Command struck_command(const Scenario& scenario, const Variant& variant, const Models& models, const fs::path& root) {
  Command command{{}, {}, root, {}};
  if (scenario.ranks > 0) {
    command.words = {models.tools().mpirun.string(), "-n", std::to_string(scenario.ranks), "--oversubscribe"};
    command.environment = {{"OMPI_ALLOW_RUN_AS_ROOT", "1"}, {"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"}};
  }
  command.words.push_back(models.tools().program.string());
  const auto& words = scenario.commands.front();
  command.words.insert(command.words.end(), words.begin(), words.end());
  if (words.front() == "study") {
    command.words.insert(command.words.end(), {"-j", std::to_string(variant.threads)});
    // An instant that is never reached, which makes every team be saved by itself.
    if (variant.each) command.environment.emplace_back("KITH_FAILPOINT", "none:1");
  }
  return command;
}

void use_shim(Command& command, const Scenario& scenario, const Models& models, const fs::path& counts,
              const std::string& fault) {
  command.environment.emplace_back("LD_PRELOAD", models.tools().shim.string());
  command.environment.emplace_back("KITH_FAULT_COUNT", counts.string());
  const auto root = scenario.where == Where::kOutput ? command.folder.parent_path() : command.folder;
  command.environment.emplace_back("KITH_FAULT_ROOT", root.string());
  if (!fault.empty()) command.environment.emplace_back("KITH_FAULT", fault);
  // One of the ranks; which one, follows from the fault.
  if (scenario.ranks > 0) command.environment.emplace_back("KITH_FAULT_RANK", std::to_string(fault.size() % 2));
}

Outcome try_case(const Case& one, const Scenario& scenario, const Models& models, const fs::path& folder) {
  return Trial{one, scenario, models, folder}.run();
}

}  // namespace kith::faults
