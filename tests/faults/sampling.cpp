#include "sampling.hpp"

#include <algorithm>
#include <chrono>
#include <set>
#include <sstream>

#include "damage.hpp"
#include "draw.hpp"
#include "kith/files/atomic_file.hpp"
#include "trial.hpp"

namespace kith::faults {
namespace {

namespace fs = std::filesystem;

bool writes(const std::string& kind) {
  return kind == "write" || kind == "pwrite" || kind == "writev" || kind == "pwritev";
}

// What can become of a call of this kind.
std::vector<std::string> actions(const std::string& kind, const std::string& family) {
  if (family == "kill") {
    return writes(kind) ? std::vector<std::string>{"kill", "killafter", "torn"}
                        : std::vector<std::string>{"kill", "killafter"};
  }
  if (writes(kind)) return {"EIO", "ENOSPC", "EINTR", "short", "full"};
  if (kind == "open") return {"EIO", "ENOSPC", "EINTR", "full"};
  if (kind == "mkdir" || kind == "link" || kind == "fallocate") return {"EIO", "ENOSPC", "full"};
  if (kind == "fsync" || kind == "fdatasync") return {"EIO", "ENOSPC", "EINTR"};
  if (kind == "ftruncate" || kind == "close") return {"EIO", "EINTR"};
  if (kind == "rename") return {"EIO", "ENOSPC"};
  return {"EIO"};
}

// The instants of `kith study` and `kith merge`, with a delay in some draws.
std::string draw_instant(RandomStream& random) {
  static const std::vector<std::string> kInstants{"team",   "commit",        "committed", "staged",   "generation",
                                                  "inputs", "manifest.json", "tables",    "published"};
  const auto& instant = drawn_from(kInstants, random);
  const bool is_team = instant == "team" || instant.rfind("commit", 0) == 0;
  auto text = instant + ":" + std::to_string(is_team ? 1 + random() % 8 : 1);
  if (random() % 2 == 0) text += ":" + std::to_string(1 + random() % 3000);
  return text;
}

bool concerns(const std::string& family, const Scenario& scenario) {
  const bool is_damage = family == "flip" || family == "truncate" || family == "mix";
  if (is_damage != (scenario.where == Where::kFolder)) return false;
  if (scenario.where == Where::kOutput) return family != "failpoint";
  return scenario.ranks == 0 || family == "kill" || family == "io" || family == "none";
}

}  // namespace

const std::vector<std::string>& all_families() {
  static const std::vector<std::string> kAll{"none", "kill", "timer", "failpoint", "io", "flip", "truncate", "mix"};
  return kAll;
}

Sampler::Sampler(const Models& models, const std::vector<Scenario>& scenarios, std::uint64_t seed, fs::path scratch)
    : models_{models}, scenarios_{scenarios}, seed_{seed}, scratch_{std::move(scratch)} {}

std::vector<Case> Sampler::draw(const std::string& family, std::size_t number) {
  auto random = RandomStream{seed_}.split(family);
  std::vector<const Scenario*> turns;
  for (const auto& scenario : scenarios_) {
    if (concerns(family, scenario)) turns.push_back(&scenario);
  }
  std::vector<Case> cases;
  std::set<std::string> known;
  std::size_t fruitless = 0;
  for (std::size_t i = 0; cases.size() < number && !turns.empty() && fruitless < 50 * turns.size(); ++i) {
    const auto& scenario = *turns[i % turns.size()];
    const bool is_slow = scenario.ranks > 0 && i / turns.size() % 8 != 0;  // mpirun takes a second
    const auto one = is_slow ? std::nullopt : draw_one(scenario, family, random);
    const bool is_new = one && known.insert(to_text(*one)).second;
    fruitless = is_new ? 0 : fruitless + 1;
    if (is_new) cases.push_back(*one);
  }
  return cases;
}

std::optional<Case> Sampler::draw_one(const Scenario& scenario, const std::string& family, RandomStream& random) {
  // Damaged journals come in several forms, further numbers of a preparation.
  const int forms = scenario.preparations.front().damaged.empty() ? 1 : 4;
  Variant variant;
  variant.preparation = static_cast<int>(random() % (scenario.preparations.size() * static_cast<unsigned>(forms)));
  variant.threads = random() % 3 == 0 ? 2 : 1;
  variant.each = random() % 3 != 0;
  Case one{scenario.name, number_of(variant), family, "-"};
  if (family == "none") return one;
  if (family == "failpoint") {
    one.fault = draw_instant(random);
  } else if (family == "timer") {
    const auto end = static_cast<std::uint64_t>(undisturbed(scenario, one.variant).microseconds);
    one.fault = std::to_string(random() % (end + 1));
  } else if (scenario.where == Where::kFolder) {
    prepare(scenario, variant, models_, scratch_ / "draw" / "root");
    one.fault = draw_damage(family, scratch_ / "draw" / "root", scenario.damaged, models_, random);
    fs::remove_all(scratch_ / "draw");
  } else {
    one.fault = draw_call(undisturbed(scenario, one.variant), family, random);
  }
  if (one.fault.empty()) return std::nullopt;
  return one;
}

// Half of the draws take every kind to be as likely as any other, half every call.
std::string Sampler::draw_call(const Run& run, const std::string& family, RandomStream& random) const {
  if (run.calls.empty()) return {};
  std::uint64_t all = 0;
  for (const auto& [kind, number] : run.calls) all += number;
  auto call = random() % all;
  auto chosen = run.calls.begin() + static_cast<std::ptrdiff_t>(random() % run.calls.size());
  if (random() % 2 == 0) {
    for (chosen = run.calls.begin(); call >= chosen->second; ++chosen) call -= chosen->second;
  } else {
    call %= chosen->second;
  }
  return chosen->first + ":" + std::to_string(call + 1) + ":" + drawn_from(actions(chosen->first, family), random);
}

const Sampler::Run& Sampler::undisturbed(const Scenario& scenario, int variant) {
  const auto name = scenario.name + " " + std::to_string(variant);
  const auto found = runs_.find(name);
  if (found != runs_.end()) return found->second;
  const auto folder = scratch_ / "count";
  prepare(scenario, variant_of(variant), models_, folder / "root");
  auto command = struck_command(scenario, variant_of(variant), models_, folder / "root");
  use_shim(command, scenario, models_, folder / "counts", "");
  const auto begin = std::chrono::steady_clock::now();
  (void)faults::run(command);  // if it fails, family none says so
  Run run;
  run.microseconds =
      std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - begin).count();
  std::istringstream lines{fs::exists(folder / "counts") ? read_file(folder / "counts") : ""};
  std::string kind;
  for (std::uint64_t number = 0; lines >> kind >> number;) run.calls.emplace_back(kind, number);
  fs::remove_all(folder);
  return runs_.emplace(name, std::move(run)).first->second;
}

}  // namespace kith::faults
