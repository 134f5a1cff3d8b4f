// The folders of three shards with some of their files edited, put together in any order, twice or not at all. What is
// put together holds all teams of one study, in the very bytes that were written; where less is allowed, it says what
// is missing.

#include "../folders.hpp"
#include "../scratch.hpp"
#include "../small_run.hpp"
#include "kith/runs/merge.hpp"

using namespace kith;
using fuzzing::require;

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kShards = 3;
constexpr std::size_t kTeams = 4;

// The shards of two studies that differ in their seeds, and the records of each by JournalIdentity::key().
struct Runs {
  fuzzing::Scratch scratch;
  fuzzing::FolderContent sound, foreign;
  std::map<std::string, std::map<std::size_t, std::string>> records;

  Runs() {
    const Atlas atlas{*fuzzing::small_study(1).domain};
    for (std::size_t i = 1; i <= kShards; ++i) {
      const Shard shard{i, kShards};
      for (const auto& [name, seed] : {std::pair{"run", 1u}, {"other", 2u}}) {
        fuzzing::run_small_study(folder(name, i), atlas, seed, shard);
        auto journal = Journal::read(folder(name, i) / kJournalFile);
        auto& of_study = records[journal.identity().key()];
        journal.for_each([&](std::size_t team, std::string_view bytes) { of_study.emplace(team, bytes); });
      }
    }
    sound = fuzzing::content_of(path());
    foreign = fuzzing::content_of(scratch.path() / "other");
    for (const auto& [key, teams] : records) require(teams.size() == kTeams, "the shards hold all teams");
    require(records.size() == 2, "the studies are told apart");
  }
  [[nodiscard]] fs::path path() const { return scratch.path() / "run"; }
  [[nodiscard]] fs::path folder(const char* run, std::size_t shard) const {
    fs::create_directories(scratch.path() / run);
    return scratch.path() / run / std::to_string(shard);
  }
};

Runs& runs() {
  static Runs runs;
  return runs;
}

void check(const Shards& shards, bool allow_partial) {
  std::map<std::size_t, std::string> found;
  for (const auto& journal : shards.journals) {
    for (std::size_t team = 1; team <= kTeams; ++team) {
      if (journal.done().size() < team || !journal.done()[team - 1]) continue;
      found.emplace(team, journal.find(team).value());
    }
  }
  for (const auto& [team, bytes] : found) {
    const auto& written = runs().records.at(shards.journals.front().identity().key());
    require(bytes == written.at(team), "a team's record is the one that was written, all of one study");
  }
  require(found.size() == kTeams || (allow_partial && !shards.missing.empty()), "all teams are there, or it is said");
}

}  // namespace

const fuzzing::Form fuzzing::kForm{.head_bytes = 2, .width = fuzzing::kEditSize};

// The first byte says whether something may be missing, the second which folders are named: four times two bits.
fuzzing::Outcome fuzzing::run(std::string_view input) {
  fuzzing::Bytes bytes{input};
  const auto& made = runs();
  const bool allow_partial = bytes.below(2) != 0;
  std::vector<fs::path> folders;
  for (unsigned choice = bytes.byte(); choice != 0; choice >>= 2) {
    if ((choice & 3u) != 0) folders.push_back(made.folder("run", choice & 3u));
  }
  if (folders.empty()) {
    for (std::size_t i = 1; i <= kShards; ++i) folders.push_back(made.folder("run", i));
  }
  fuzzing::put(made.path(), fuzzing::edited(made.sound, made.foreign, bytes));
  const auto outcome = fuzzing::reads({}, "", [&] {
    const auto shards = open_shards(folders, fuzzing::kProgram, allow_partial);
    check(shards, allow_partial);
  });
  fuzzing::put(made.path(), made.sound);
  return outcome;
}
