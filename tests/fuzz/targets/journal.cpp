// A journal of twelve teams whose file is damaged: bytes set, bits flipped, sectors of zeros, an end cut off. Whatever
// can still be opened is of the same study and holds, of every team that it says is done, the very bytes that were
// written; what was recovered needs no recovery any more.

#include "kith/runs/journal.hpp"
#include "../fuzzing.hpp"
#include "../scratch.hpp"
#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/runs/team_codec.hpp"

using namespace kith;
using fuzzing::require;

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kTeams = 12;

const JournalIdentity& identity() {
  static const JournalIdentity kIdentity{{"a study", "a domain"}, "1.0", kTeams, {}};
  return kIdentity;
}

std::string record_of(std::size_t team) {
  TeamRecord record;
  record.address.team = team;
  record.seed_address = std::string(40 * team, 'a');
  return encode_team(record, identity().key());
}

// The file of a finished journal.
std::string sound_journal(const fs::path& path) {
  auto journal = Journal::create(path, identity());
  journal.begin_session();
  for (std::size_t team = 1; team <= kTeams; ++team) {
    const JournalEntry entry{team, record_of(team)};
    journal.write({&entry, 1});
  }
  journal.close();
  return read_file(path);
}

void damage(std::string& file, fuzzing::Bytes bytes) {
  constexpr std::size_t kSector = 512;
  while (!bytes.empty() && !file.empty()) {
    const auto kind = bytes.below(8);
    const auto at = (bytes.below(256) * 256 + bytes.below(256)) % file.size();
    const auto value = bytes.byte();
    if (kind < 4) file[at] = static_cast<char>(value);
    if (kind == 4 || kind == 5) file[at] = static_cast<char>(file[at] ^ (1 << (value % 8)));
    if (kind == 6) file.replace(at / kSector * kSector, kSector, kSector, '\0');
    if (kind == 7) file.resize(at);
  }
}

void check(const Journal& journal) {
  require(journal.identity() == identity(), "what can be opened says whose it is");
  require(journal.done().size() == kTeams, "there is a place for every team");
  std::size_t seen = 0;
  journal.for_each([&](std::size_t team, std::string_view bytes) {
    require(bytes == record_of(team), "what is there is what was written");
    ++seen;
  });
  require(seen == journal.num_done(), "teams that are done are there");
}

}  // namespace

const fuzzing::Form fuzzing::kForm{.width = 4};

fuzzing::Outcome fuzzing::run(std::string_view input) {
  static const fuzzing::Scratch kScratch;
  static const auto kPath = kScratch.path() / "study.sqlite";
  static const std::string kSound = sound_journal(kPath);
  auto file = kSound;
  damage(file, fuzzing::Bytes{input});
  for (const auto& entry : fs::directory_iterator{kScratch.path()}) fs::remove(entry);
  write_file_atomically(kPath, file);
  std::vector<bool> done;
  const auto outcome = fuzzing::reads({}, "", [&] {
    auto journal = Journal::open(kPath, identity());
    if (!journal) throw Error{ErrorKind::kIo, "nothing can be read from it"};
    done = journal->done();
    if (journal->damaged().empty()) check(*journal);
    journal->close();
  });
  require(outcome == Outcome::kRead || done.empty(), "what was opened can be read");
  if (outcome != Outcome::kRead) return outcome;
  const auto again = Journal::open(kPath, identity());
  require(again && !again->was_recovered() && again->done() == done, "opening again finds the same");
  return outcome;
}
