#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "build_facts.hpp"
#include "command.hpp"
#include "embedded.hpp"
#include "input.hpp"
#include "interrupt.hpp"
#include "kith/bec/memory_needs.hpp"
#include "kith/core/error.hpp"
#include "kith/core/parallel.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/explain/curriculum.hpp"
#include "kith/explain/words.hpp"
#include "kith/explain/wrapped.hpp"
#include "kith/files/folder_lock.hpp"
#include "kith/files/generation.hpp"
#include "kith/runs/journal.hpp"
#include "kith/runs/run_folder.hpp"
#include "kith/runs/team_codec.hpp"
#include "kith/store/event_file.hpp"
#include "kith/store/session_audit.hpp"
#include "kith/study/audit_people.hpp"
#include "kith/study/exam_rehearsal.hpp"
#include "kith/teaching/cache_pool.hpp"
#include "kith/teaching/kind_of_person.hpp"
#include "page.hpp"
#include "progress.hpp"

namespace kith::cli {
namespace {

struct AuditCommandOptions {
  std::string folder;
  std::string exam;                 ///< Domain of a rehearsal; empty: none.
  std::size_t people = 100;         ///< Of every kind in a rehearsal.
  std::optional<std::size_t> team;  ///< Number of a team of a run; none: all.
  std::string room;                 ///< Id or code of a room of a live session; empty: all.
  std::string out;                  ///< Where the page goes; "-" is standard output; empty: no page.
  std::string knowing;              ///< The robot before an update, which people knew; empty: as the study says.
  double forgetting = 0.02;         ///< Radians per period without lessons.
  std::size_t threads = 0;          ///< 0: as many as there are cores.
  ProgressMode progress = ProgressMode::kAuto;
};

namespace fs = std::filesystem;

Error refusal(ErrorKind kind, const std::string& id, const std::string& message, const std::string& hint) {
  return Error{
      kind, message, {{.id = id, .message = message, .hint = hint, .infeasible = kind == ErrorKind::kInfeasible}}};
}

// --- a run ---------------------------------------------------------------------------------------------------------

class RunAudit {
 public:
  RunAudit(const AuditCommandOptions& options, Console& console) : options_{options}, console_{console} {
    const fs::path folder{options.folder};
    if (!is_busy(folder)) settle_for_reading(folder);
    auto reading = read_run_folder(folder);
    if (!reading.study || !reading.domain) throw Error{reading.diagnostics};
    study_ = *std::move(reading.study);
    require_teaching_memory(*reading.domain);
    atlas_ = std::make_unique<const Atlas>(*std::move(reading.domain));
    if (!options.knowing.empty()) {
      for (auto& variant : study_.variants) variant.teaching.known = known_before(options.knowing, *atlas_);
    }
    read(Journal::read(folder / kJournalFile));
  }

  [[nodiscard]] const Atlas& atlas() const { return *atlas_; }

  AuditReport report() {
    std::vector<std::vector<AuditedPerson>> judged(records_.size());
    CachePool caches{*atlas_};
    watch_signals();
    Progress progress{options_.progress, console_};
    const auto on_progress = [&](std::size_t done, std::size_t total) {
      progress.update(done, total, 0);
      return stop_signal() == 0;
    };
    const bool all =
        for_each_index(records_.size(), {.threads = options_.threads, .on_progress = on_progress}, [&](std::size_t i) {
          auto cache = caches.take();
          judged[i] = audit_team(*cache, study_, records_[i], options_.forgetting);
          caches.give_back(std::move(cache));
        });
    progress.finish();
    if (!all) throw Error{ErrorKind::kPartial, "interrupted; nothing was written"};
    AuditReport report{.source = options_.folder,
                       .people = {},
                       .options = audit_options(study_.variants[0].teaching, options_.forgetting)};
    for (auto& team : judged)
      for (auto& member : team) report.people.push_back(std::move(member));
    return report;
  }

 private:
  void read(const Journal& journal) {
    if (study_.variants[0].record == RecordLevel::kTeam) {
      throw refusal(ErrorKind::kInfeasible, "E1113",
                    options_.folder + " has no answers: only the results of whole teams were recorded",
                    "run the study with record.level = \"period\"");
    }
    const auto total = num_teams(study_);
    if (options_.team) {
      const auto wrong = wrong_integer(std::to_string(*options_.team), {1, static_cast<std::int64_t>(total)});
      if (!wrong.empty()) refuse("--team " + wrong);
      const auto bytes = journal.find(*options_.team);
      if (!bytes) {
        throw refusal(ErrorKind::kInfeasible, "E1115",
                      fmt::format("team {} of {} has not been taught yet, or failed", *options_.team, options_.folder),
                      "kith status shows how far the run is");
      }
      add(journal, *options_.team, *bytes);
      return;
    }
    journal.for_each([&](std::size_t team, std::string_view bytes) { add(journal, team, bytes); });
    if (records_.empty()) {
      throw refusal(ErrorKind::kInfeasible, "E1115", "no team of " + options_.folder + " has been taught yet",
                    "kith status shows how far the run is");
    }
  }

  void add(const Journal& journal, std::size_t team, std::string_view bytes) {
    auto record = decode_team(team_address(study_, team), bytes, journal.key());
    if (!record) {
      throw Error{ErrorKind::kIo, fmt::format("the record of team {} in {} cannot be read", team, options_.folder)};
    }
    // What is not observed is not kept.
    record->beliefs.clear();
    record->progress.clear();
    records_.push_back(*std::move(record));
  }

  const AuditCommandOptions& options_;
  Console& console_;
  Study study_;
  std::unique_ptr<const Atlas> atlas_;
  std::vector<TeamRecord> records_;
};

// --- as text -------------------------------------------------------------------------------------------------------

std::string percent(double share) { return fmt::format("{:.0f} %", 100.0 * share); }

class AuditText {
 public:
  AuditText(const Atlas& atlas, const AuditReport& report, const Console& console)
      : atlas_{atlas}, report_{report}, console_{console} {}

  std::string text(bool everybody) {
    summary();
    if (!everybody) return out_;
    std::string group;
    for (const auto& person : report_.people) {
      if (person.group != group) {
        out_ += "\n" + console_.bold(person.group) + "\n";
        line(agreement_in_words(report_, person.group), 0);
      }
      group = person.group;
      out_ += "\n" + title_of(person) + "\n";
      if (const auto caution = caution_in_words(person.audit); !caution.empty()) line(caution, 2);
      if (const auto older = older_in_words(person.audit); !older.empty()) line(older, 2);
      if (const auto knows = person.audit.knowledge())
        line(fmt::format("knows {} of what was taught", percent(*knows)), 2);
      if (!person.kinds.empty()) line("kind of learner: " + kinds_in_words(person.kinds), 2);
      for (const auto& audit : person.audit.components) component(audit);
    }
    return out_;
  }

 private:
  void line(const std::string& text, std::size_t indent) {
    const std::string blank(indent, ' ');
    out_ += wrapped(text, kTextWidth, blank, blank) + "\n";
  }

  void summary() {
    TextTable table{"lrrrr"};
    table.add({"component", "understand", "cannot tell", "misconception", "not taught"});
    for (std::size_t k = 0; k < atlas_.knowledge_components().size(); ++k) {
      const auto counts = counts_of(report_, k);
      table.add({std::to_string(k + 1) + ". " + atlas_.knowledge_components()[k].name,
                 std::to_string(counts.understand), std::to_string(counts.cannot_tell),
                 std::to_string(counts.misconception), std::to_string(counts.not_taught)});
    }
    out_ += table.text(console_) + "\n";
    line(agreement_in_words(report_), 0);
    if (const auto older = older_in_words(report_); !older.empty()) line(older, 0);
    const auto shared = shared_misconceptions(report_);
    if (!shared.empty()) out_ += "\nMisconceptions, with the number of people\n";
    for (const auto& misconception : shared) {
      line(fmt::format("{}: thinks that {}; in fact, {} (component {})", misconception.people,
                       misconception.thinks.front(), misconception.fact, misconception.component + 1),
           2);
    }
  }

  void component(const ComponentAudit& audit) {
    line(fmt::format("{}. {}: {}", audit.component + 1, component_in_words(atlas_, audit.component),
                     verdict_in_words(audit)),
         2);
    if (audit.understanding == Understanding::kNotTaught) return;
    line(fmt::format("understands with probability {}; expected to get all of it right {} of the time ({} interval: {} "
                     "to {}); {} of {} right in {}",
                     percent(audit.level.probability), percent(audit.level.mean),
                     percent(report_.options.level.coverage), percent(audit.level.low), percent(audit.level.high),
                     audit.correct, counted(audit.tests, "answer"), counted(audit.periods, "lesson")),
         5);
    if (audit.misconception) misconception(audit, *audit.misconception);
    line("next: " + advice_in_words(audit), 5);
    if (audit.test) line("test: " + place(*audit.test), 5);
  }

  void misconception(const ComponentAudit& audit, const LikelyMisconception& found) {
    const bool sure = audit.understanding == Understanding::kMisconception;
    line(fmt::format("{} that {} (probability {}); in fact, {}", sure ? "probably thinks" : "might think", found.thinks,
                     percent(found.probability), found.fact),
         5);
    for (const auto& answer : found.answers) {
      line(fmt::format("period {}, test {} ({}), predicted: {}", answer.period, answer.test,
                       world_text(atlas_.domain(), atlas_.id(answer.start).mdp), answer.text),
           7);
    }
    if (found.show) line("show: " + place(*found.show) + (found.reason.empty() ? "" : "; " + found.reason), 5);
  }

  [[nodiscard]] std::string place(StartIndex start) const {
    const auto id = atlas_.id(start);
    return fmt::format("{}, start {}", world_text(atlas_.domain(), id.mdp), id.start.value());
  }

  const Atlas& atlas_;
  const AuditReport& report_;
  const Console& console_;
  std::string out_;
};

int show(const Atlas& atlas, const AuditReport& report, const AuditCommandOptions& options, Console& console) {
  constexpr std::size_t kFew = 30;  // people; of more, the text has the summary only
  auto document = audit_json(atlas, report, program_name());
  if (!options.out.empty()) {
    auto shown = document;
    shown.erase("source");  // where the folder is on this machine
    write_page("audit", page_with(shown.dump(-1, ' ', true), detail::kAuditPage), options.out, console);
  }
  if (console.json()) {
    console.print_json(document);
  } else if (options.out.empty()) {
    const bool everybody = report.people.size() <= kFew;
    console.print(AuditText{atlas, report, console}.text(everybody));
    if (!everybody) console.info("--team N shows the people of one team; -o PAGE.html shows everybody");
  }
  return 0;
}

void declare(OptionList& list, AuditCommandOptions& options) {
  const auto folder = list.text("folder", options.folder, "DIR", "Run folder of a study, or folder of live sessions");
  const auto team = list.integer("--team", options.team, {1}, "Only this team of a run, as numbered in teams.csv");
  const auto room = list.text("--room", options.room, "ID", "Only this room of live sessions, by id or code");
  const auto out =
      list.text("-o,--out", options.out, "FILE", "Write one HTML page for a browser; '-' is standard output");
  const auto knowing =
      list.text("--knowing", options.knowing, "DOMAIN", "The robot before an update, to say who still believes in it");
  list.number("--forgetting", options.forgetting, "ANGLE", {0.0, kLargestNumber},
              "Radians by which beliefs blur in a period without lessons; 0: people forget nothing");
  list.text("--exam", options.exam, "DOMAIN", "Rehearse an exam with simulated people instead; a name or a file")
      .excludes(folder)
      .excludes(team)
      .excludes(room)
      .excludes(out)
      .excludes(knowing);
  list.integer("--people", options.people, {1, 100'000}, "With --exam: people of every kind");
  list.threads(options.threads);
  list.progress(options.progress);
  list.json();
}

std::string share_in_words(std::size_t part, std::size_t all) {
  return all == 0 ? "-" : percent(static_cast<double>(part) / static_cast<double>(all));
}

// What an exam of people finds out who were taught by simulated lessons.
int rehearse(const AuditCommandOptions& options, Console& console) {
  const Atlas atlas{load_domain(options.exam)};
  require_something_to_teach(atlas);
  auto study = study_of("paper", {}).study->variants.front();
  take_domain(study, atlas.domain());
  watch_signals();
  Progress progress{options.progress, console};
  const auto on_progress = [&](std::size_t done, std::size_t total) {
    progress.update(done, total, 0);
    return stop_signal() == 0;
  };
  const auto kinds =
      rehearse_exam(atlas, study, {.people = options.people, .threads = options.threads, .on_progress = on_progress});
  progress.finish();
  if (kinds.empty()) throw Error{ErrorKind::kPartial, "interrupted; nothing was written"};
  const auto text = [&] {
    const auto& taught = kinds.front();
    TextTable found{"rr"};
    found.add({"boards", "components understood that are found"});
    for (std::size_t i = 0; i < kExamLengths.size(); ++i) {
      found.add({std::to_string(kExamLengths[i]), share_in_words(taught.findings[i].rightly, taught.understood)});
    }
    TextTable table{"lrrrrr"};
    table.add({"people", "number", "mostly wrong", "passed anyway", "passed below 80 %", "boards"});
    for (const auto& kind : kinds) {
      table.add({kind.kind, std::to_string(kind.people), std::to_string(kind.mistaken),
                 std::to_string(kind.findings.back().wrongly), std::to_string(kind.findings.back().nearly),
                 fmt::format("{:.1f}", static_cast<double>(kind.boards) / static_cast<double>(kind.people))});
    }
    return "People who learn as assumed, after an exam of at most so many boards\n" + found.text(console) +
           "\nAll kinds of people: how many get some component wrong more often than right,\n"
           "how many of them are said to understand it, and how many who get it right less\nthan 80 % of the time\n" +
           table.text(console);
  };
  console.print([&] { return rehearsal_json(atlas, kinds, program_name()); }, text);
  return 0;
}

int run(const AuditCommandOptions& options, Console& console) {
  if (!options.exam.empty()) return rehearse(options, console);
  if (options.folder.empty()) refuse("kith audit needs the folder of a study or of live sessions, or --exam DOMAIN");
  const fs::path folder{options.folder};
  std::error_code none;
  if (fs::exists(folder / kEventFile, none)) {
    if (options.team) refuse("--team is for run folders; --room ID names a room of a live session");
    const auto audit =
        audit_session(EventFile::read(folder), {.source = options.folder,
                                                .room = options.room,
                                                .forgetting = options.forgetting,
                                                .on_progress = {},
                                                .known = [&](const Atlas& atlas) -> std::optional<Cone> {
                                                  return options.knowing.empty()
                                                             ? std::nullopt
                                                             : std::optional{known_before(options.knowing, atlas)};
                                                }});
    return show(*audit.study->atlas, audit.report, options, console);
  }
  if (!options.room.empty()) refuse("--room is for live sessions; --team N names a team of a run");
  if (!Journal::exists(folder / kJournalFile)) {
    throw refusal(ErrorKind::kIo, "E1114", options.folder + " holds neither a run nor a live session",
                  "give the folder of -o of kith study or kith serve");
  }
  RunAudit audit{options, console};
  return show(audit.atlas(), audit.report(), options, console);
}

}  // namespace

void add_audit(Commands& commands) {
  commands.add<AuditCommandOptions>(
      "audit", "Judge from people's answers who understands what",
      {"kith audit results/paper", "kith audit results/paper --team 17",
       "kith audit results/live --room r3 -o audit.html", "kith audit --exam item-delivery"},
      declare, run);
}

}  // namespace kith::cli
