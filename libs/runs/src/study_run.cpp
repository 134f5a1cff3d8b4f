#include "kith/runs/study_run.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>

#include "extend.hpp"
#include "journal_writer.hpp"
#include "kith/core/assert.hpp"
#include "kith/core/error.hpp"
#include "kith/core/stream.hpp"
#include "kith/files/bytes.hpp"
#include "kith/runs/team_codec.hpp"
#include "team_list.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kNoMoreWork = std::uint64_t{1} << 40;  // taken by whoever stops, so that nobody gets more

fs::path rank_journal(const fs::path& folder, std::size_t rank) {
  return folder / (std::string{kRankJournalPrefix} + std::to_string(rank) + ".sqlite");
}

// What rank 0 tells the others after it has opened the folder.
std::string pack(const std::vector<bool>& done) {
  ByteWriter writer;
  writer.count(done.size());
  for (const bool one : done) writer.flag(one);
  return std::move(writer).take();
}

std::vector<bool> unpack(const std::string& bytes) {
  ByteReader reader{bytes};
  std::vector<bool> done(reader.length());
  for (std::size_t i = 0; i < done.size(); ++i) done[i] = reader.flag();
  return done;
}

void shuffle(std::vector<std::uint32_t>& teams, std::uint64_t seed) {
  RandomStream random{seed};
  for (std::size_t i = teams.size(); i > 1; --i) std::swap(teams[i - 1], teams[random() % i]);
}

// Rethrows what a team threw, its address in front.
[[noreturn]] void rethrow(const std::exception_ptr& failure, const std::string& team) {
  try {
    std::rethrow_exception(failure);
  } catch (const Error& error) {
    throw Error{error.kind(), team + " failed: " + error.what()};
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw std::runtime_error{team + " failed: " + error.what()};
  }
}

std::string message_of(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "unknown";
  }
}

}  // namespace

struct StudyRun::State {
  // The whole machine's ranks where there is only one.
  class Alone final : public Ranks {
   public:
    std::uint64_t take(std::uint64_t n) override { return next_.fetch_add(n); }
    [[nodiscard]] std::size_t rank() const override { return 0; }
    [[nodiscard]] std::size_t size() const override { return 1; }
    [[nodiscard]] std::string broadcast(std::string bytes) override { return bytes; }
    [[nodiscard]] bool any(bool mine) override { return mine; }
    void wait_for_all() override {}
    [[nodiscard]] std::size_t num_on_this_machine() override { return 1; }

   private:
    std::atomic<std::uint64_t> next_{0};
  };

  State(fs::path where, StudyReading what, StudyRunOptions how)
      : path{std::move(where)}, reading{std::move(what)}, options{std::move(how)} {
    ranks = options.ranks == nullptr ? &alone : options.ranks;
    identity = {freeze(reading), options.program, kith::num_teams(*reading.study), options.shard};
    KITH_ASSERT(identity.teams < kNoMoreWork);
  }

  [[nodiscard]] std::string describe(std::size_t team) const {
    return describe_team(*reading.study, team_address(*reading.study, team));
  }

  void open_folder();
  void open_journal();
  void begin_journal();
  void extend(const JournalIdentity& found);
  [[nodiscard]] bool open_own_journal();
  void refuse_other_journal(const JournalIdentity& found);
  void take_up_rank_journals();
  void note_damage(const Journal& one);
  void find_work(const std::vector<bool>& done);

  fs::path path;
  StudyReading reading;
  StudyRunOptions options;
  Alone alone;
  Ranks* ranks;
  JournalIdentity identity;
  std::optional<RunFolder> folder;  // of rank 0
  std::optional<Journal> journal;
  std::vector<std::uint32_t> work;  // the teams that are missing, in the order in which they are begun
  std::size_t teams = 0;
  std::size_t resumed = 0;
  bool all_taught = false;
  std::vector<std::string> notes;
  std::vector<TeamFailure> failures;
};

void StudyRun::State::note_damage(const Journal& one) {
  const auto& file = one.path().string();
  if (one.was_recovered()) {
    std::vector<std::size_t> lost;
    for (std::size_t team = 1; team <= one.done().size(); ++team) {
      if (options.shard.contains(team) && !one.done()[team - 1]) lost.push_back(team);
    }
    notes.push_back(
        file + " was damaged: " + std::to_string(one.num_done()) + " teams were recovered from it, " +
        (lost.empty() ? "all of them" : std::to_string(lost.size()) + " are rerun (" + team_list(lost) + ")") +
        "; it is kept as " + file + ".damaged");
  }
  for (const auto team : one.damaged()) {
    notes.push_back("the record of " + describe(team) + " in " + file + " is damaged; the team is rerun");
  }
}

void StudyRun::State::begin_journal() { journal = Journal::create(path / kJournalFile, identity); }

// Whether it could be opened to go on with.
bool StudyRun::State::open_own_journal() {
  const auto file = path / kJournalFile;
  journal = Journal::open(file, identity);
  if (journal) {
    note_damage(*journal);
    return true;
  }
  if (!options.replace && !options.rebuild) {
    throw Error{
        ErrorKind::kIo, file.string() + " is damaged, and no record of this study can be read from it",
        Advice{"restore the file from a copy or with 'sqlite3 " + file.string() + " .recover'", Remedy::kStartOver}};
  }
  notes.push_back(file.string() +
                  " is damaged, and no record of this study can be read from it; the study starts over");
  return false;
}

// What keeps us from going on with the work of somebody else, or from replacing it without being told.
void StudyRun::State::refuse_other_journal(const JournalIdentity& found) {
  if (found.inputs != identity.inputs && identity.shard.count > 1) {
    throw Error{ErrorKind::kUsage,
                path.string() + " holds a shard of this study with fewer replicates, and shards cannot be extended",
                "extend the folder that they are merged into"};
  }

  if (found.shard != identity.shard) {
    throw Error{ErrorKind::kUsage,
                path.string() + " holds shard " + std::to_string(found.shard.index) + "/" +
                    std::to_string(found.shard.count) + " of this study, not " + std::to_string(identity.shard.index) +
                    "/" + std::to_string(identity.shard.count),
                Remedy::kReplaceContents};
  }

  const auto progress = Journal::read(path / kJournalFile).progress();
  const auto by = "by kith " + found.program + ", and this is " + identity.program;
  if (progress.done < progress.total) {
    throw Error{ErrorKind::kUsage,
                path.string() + " holds " + std::to_string(progress.done) + " of " + std::to_string(progress.total) +
                    " teams taught " + by + ", so results may differ",
                Advice{"finish the run with that program", Remedy::kStartOver}};
  }
  notes.push_back("the results in " + path.string() + " were made " + by + "; all teams are rerun");
}

void StudyRun::State::open_journal() {
  const auto file = path / kJournalFile;
  const bool there = Journal::exists(file);
  if (!there && folder->has_results()) {
    notes.push_back(file.string() + " is missing, so all teams of the finished run are " +
                    (options.rebuild ? "read" : "taught") + " again");
  }
  if (!there && options.resume == Resume::kRequire) {
    throw Error{ErrorKind::kUsage, "there is nothing to resume in " + path.string(), Remedy::kAllowStart};
  }
  if (!there || options.resume == Resume::kNever) return begin_journal();
  std::optional<JournalIdentity> found;
  try {
    found = Journal::identify(file);
  } catch (const Error& error) {
    if (!options.replace || error.kind() != ErrorKind::kUsage) throw;
    return begin_journal();  // of another version of kith
  }
  if (!found || *found == identity) {
    if (!open_own_journal()) begin_journal();
    return;
  }
  if (options.resume == Resume::kRequire) {
    throw Error{ErrorKind::kUsage,
                path.string() + " belongs to another study, shard, program or machine (kith " + found->program +
                    "); there is nothing to resume",
                Remedy::kAllowStart};
  }

  const bool is_part = extends(found->inputs, identity.inputs);
  auto extended = *found;
  extended.inputs = identity.inputs;
  extended.teams = identity.teams;
  if (is_part && extended == identity && identity.shard.count == 1) return extend(*found);
  if (!options.replace && (is_part || found->inputs == identity.inputs)) refuse_other_journal(*found);
  begin_journal();  // RunFolder has asked
}

// The same study with more teams: those that are there count.
void StudyRun::State::extend(const JournalIdentity& found) {
  extend_journal(path / kJournalFile, found, identity, *reading.study);
  if (!open_own_journal()) return begin_journal();
  notes.push_back(path.string() + " held " + std::to_string(found.teams) + " teams of this study; " +
                  std::to_string(identity.teams - found.teams) + " are added");
}

void StudyRun::State::take_up_rank_journals() {
  for (const auto& file : rank_journals(path)) {
    const auto found = Journal::identify(file);
    if (!found || *found == identity) {
      if (const auto part = Journal::open(file, identity)) {
        note_damage(*part);
        journal->absorb(*part);
      } else {
        notes.push_back(file.string() +
                        " is damaged, and no record of this study can be read from it; its teams are rerun");
      }
    }
    Journal::remove(file);
  }
}

void StudyRun::State::open_folder() {
  folder.emplace(path, identity.inputs, options.replace);
  Journal::remove(extended_file(path / kJournalFile));
  open_journal();
  folder->freeze_inputs();
  take_up_rank_journals();
}

void StudyRun::State::find_work(const std::vector<bool>& done) {
  for (std::size_t team = 1; team <= done.size(); ++team) {
    if (!options.shard.contains(team)) continue;
    ++teams;
    if (done[team - 1]) {
      ++resumed;
    } else {
      work.push_back(static_cast<std::uint32_t>(team));
    }
  }
  if (options.shuffle) shuffle(work, *options.shuffle);
}

StudyRun::StudyRun(fs::path folder, StudyReading reading, StudyRunOptions options)
    : state_{std::make_unique<State>(std::move(folder), std::move(reading), std::move(options))} {
  auto& ranks = *state_->ranks;
  if (ranks.rank() == 0) {
    try {
      state_->open_folder();
    } catch (...) {
      (void)ranks.broadcast({});  // the others need not say it again
      throw;
    }
    (void)ranks.broadcast(ranks.size() > 1 ? pack(state_->journal->done()) : std::string{});
    state_->find_work(state_->journal->done());
  } else {
    const auto told = ranks.broadcast({});
    if (told.empty()) throw Error{ErrorKind::kIo, "rank 0 could not open the folder"};
    state_->find_work(unpack(told));
    state_->journal = Journal::create(rank_journal(state_->path, ranks.rank()), state_->identity);
  }
  state_->journal->begin_session();
}

StudyRun::~StudyRun() {
  if (!state_->folder || !state_->journal || state_->journal->num_done() > 0 || state_->all_taught) return;
  try {
    state_->journal.reset();
    if (rank_journals(state_->path).empty()) state_->folder->discard();
  } catch (const std::exception&) {  // an empty journal more does no harm
  }
}

const Study& StudyRun::study() const { return *state_->reading.study; }
std::size_t StudyRun::num_teams() const { return state_->teams; }
std::size_t StudyRun::num_resumed() const { return state_->resumed; }
std::size_t StudyRun::num_done() const { return state_->journal->num_done(); }
const std::vector<std::string>& StudyRun::notes() const { return state_->notes; }
const std::vector<TeamFailure>& StudyRun::failures() const { return state_->failures; }

bool StudyRun::teach(const Atlas& atlas) {
  auto& state = *state_;
  auto& ranks = *state.ranks;
  const auto& options = state.options;
  JournalWriter writer{*state.journal, options.checkpoint_seconds};
  std::mutex progress;
  std::size_t done = state.resumed;
  const auto sink = [&](TeamOutcome outcome) {
    const auto team = outcome.address.team;
    if (outcome.record) {
      writer.add({team, encode_team(*outcome.record, state.journal->key())});
    } else if (!options.keep_going) {
      rethrow(outcome.failure, state.describe(team));
    } else {
      writer.fail({team, message_of(outcome.failure)});
    }
    const std::lock_guard lock{progress};
    if (outcome.record) ++done;
    // Positions that others have taken are as good as done.
    if (ranks.size() > 1) done = std::max(done, state.resumed + outcome.position + 1);
    if (!outcome.record) state.failures.push_back({team, message_of(outcome.failure)});
    if (options.on_progress) options.on_progress(done, state.teams, state.failures.size());
  };

  StreamOptions stream;
  stream.threads = options.threads;
  stream.counter = &ranks;
  stream.chunk = std::clamp<std::size_t>(state.work.size() / (ranks.size() * 64), 1, ranks.size() > 1 ? 16 : 1);
  stream.stopped = options.stopped;
  std::exception_ptr failure;
  try {
    stream_teams(atlas, *state.reading.study, state.work, stream, sink);
  } catch (...) {
    failure = std::current_exception();
  }
  const bool stopped = options.stopped && options.stopped();
  if (stopped || failure) (void)ranks.take(kNoMoreWork);
  try {
    writer.flush();
  } catch (...) {
    if (!failure) failure = std::current_exception();
  }
  const bool all_well = !ranks.any(failure != nullptr);
  const bool somebody_stopped = ranks.any(stopped);
  if (failure) std::rethrow_exception(failure);
  std::sort(state.failures.begin(), state.failures.end(),
            [](const TeamFailure& a, const TeamFailure& b) { return a.team < b.team; });
  const bool finished = all_well && !somebody_stopped;
  if (ranks.rank() != 0 || !finished) state.journal->close();
  ranks.wait_for_all();
  if (!all_well) throw Error{ErrorKind::kIo, "another rank failed"};
  if (!finished) return false;
  if (ranks.rank() == 0 && ranks.size() > 1) {
    state.take_up_rank_journals();
    state.failures = state.journal->progress().failures;
  }
  state.all_taught = true;
  return true;
}

std::optional<StudySummary> StudyRun::publish(RunFacts facts) {
  auto& state = *state_;
  if (state.ranks->rank() != 0) return std::nullopt;
  for (const auto& failure : state.failures) {
    facts.failed.push_back(state.describe(failure.team) + ": " + failure.message);
  }
  StudySummarizer summarizer;
  const auto teams = teams_of(study(), *state.journal);
  const bool may_miss = !facts.missing.empty();
  const TeamSource summed = [&](const std::function<void(const TeamRecord& team)>& visit) {
    std::size_t count = state.failures.size();
    teams([&](const TeamRecord& team) {
      ++count;
      summarizer.add(team);
      visit(team);
    });
    if (count == state.identity.teams || may_miss) return;
    throw Error{ErrorKind::kMismatch, state.journal->path().string() + " holds " + std::to_string(count) + " of " +
                                          std::to_string(state.identity.teams) +
                                          " teams; rerun the command that ran the study"};
  };
  state.folder->publish(study(), summed, facts);
  state.journal->close();
  return summarizer.summary();
}

void StudyRun::publish_shard(RunFacts facts) {
  auto& state = *state_;
  if (state.ranks->rank() != 0) return;
  for (const auto& failure : state.failures) {
    facts.failed.push_back(state.describe(failure.team) + ": " + failure.message);
  }
  const auto& [index, count] = state.options.shard;
  state.journal->close();
  state.folder->publish_shard(study(), std::to_string(index) + "/" + std::to_string(count), num_done(), facts);
}

void StudyRun::take_up(const Journal& journal) {
  state_->journal->absorb(journal);
  const auto progress = journal.progress();
  state_->failures.insert(state_->failures.end(), progress.failures.begin(), progress.failures.end());
  std::sort(state_->failures.begin(), state_->failures.end(),
            [](const TeamFailure& a, const TeamFailure& b) { return a.team < b.team; });
}

TeamSource teams_of(const Study& study, const Journal& journal) {
  return [&study, &journal](const std::function<void(const TeamRecord& team)>& visit) {
    journal.for_each([&](std::size_t team, std::string_view bytes) {
      const auto record = decode_team(team_address(study, team), bytes, journal.key());
      if (!record) {
        throw Error{ErrorKind::kIo,
                    "the record of " + describe_team(study, team_address(study, team)) + " in " +
                        journal.path().string() + " cannot be read",
                    Remedy::kStartOver};
      }
      visit(*record);
    });
  };
}

}  // namespace kith
