// The folder of a small finished run with some of its files edited, opened by everything that reads runs. Each answers
// as for the untouched folder or says what is wrong with it; with a manifest that was made to match what was edited, it
// answers anything.

#include <array>
#include <sstream>

#include "../folders.hpp"
#include "../scratch.hpp"
#include "../small_run.hpp"
#include "kith/analysis/analysis.hpp"
#include "kith/core/error.hpp"
#include "kith/fit/import_logs.hpp"
#include "kith/report/report.hpp"
#include "kith/runs/verify.hpp"

using namespace kith;
using fuzzing::require;

namespace {

namespace fs = std::filesystem;

// Two runs that differ in their seeds, and an atlas of their domain.
struct Runs {
  fuzzing::Scratch scratch;
  Atlas atlas{*fuzzing::small_study(1).domain};
  fs::path folder = scratch.path() / "run";
  fuzzing::FolderContent sound, foreign;

  Runs() {
    fuzzing::run_small_study(folder, atlas, 1);
    fuzzing::run_small_study(scratch.path() / "other", atlas, 2);
    sound = fuzzing::content_of(folder);
    foreign = fuzzing::content_of(scratch.path() / "other");
  }
};

Runs& runs() {
  static Runs runs;
  return runs;
}

// What is asked of a folder, each with an answer as text.

std::string frozen_study(const fs::path& folder) {
  const auto reading = read_run_folder(folder);
  if (!reading.study) throw Error{reading.diagnostics};
  return freeze(reading).digest();
}

std::string analysis(const fs::path& folder) {
  const auto analysis = analyze_run(folder, {});
  std::string text;
  for (const auto& finding : analysis.findings) text += finding.sentence + "\n";
  return text;
}

std::string people(const fs::path& folder) {
  std::ostringstream text;
  for (const auto& person : import_run_folder(folder, AnswerDetail::kVerdict).people) {
    text << person.id << ' ' << person.type << ' ' << person.correct << ' ' << person.answered << '\n';
  }
  return text.str();
}

std::string report(const fs::path& folder) { return build_report(folder); }

std::string verification(const fs::path& folder) {
  const auto reading = read_run_folder(folder);
  if (!reading.study) throw Error{reading.diagnostics};
  VerifyOptions options;
  options.sample = 0.3;
  options.threads = 1;
  const auto result = verify_run(folder, reading, runs().atlas, options);
  if (!result.mismatches.empty()) throw Error{result.mismatches};
  return std::to_string(result.teams) + " teams, " + std::to_string(result.files) + " files";
}

std::string journal(const fs::path& folder) {
  auto journal = Journal::read(folder / kJournalFile);
  const bool sound = journal.check();
  if (!sound || !journal.damaged().empty()) throw Error{ErrorKind::kMismatch, "damaged"};
  std::string text = frozen_study(folder);
  if (journal.identity().inputs.digest() != text) throw Error{ErrorKind::kMismatch, "of another run"};
  journal.for_each([&](std::size_t team, std::string_view bytes) { text += std::to_string(team) += bytes; });
  return text;
}

constexpr std::array kQuestions{frozen_study, journal, people, analysis, verification, report};
constexpr std::size_t kQuick = 4;  // the first ones take a hundredth of the time of the others

// Whether an input asks question i: each of the quick ones unless its bit says no, each of the others one time in
// eight.
bool is_asked(unsigned choice, std::size_t i) {
  return i < kQuick ? (choice >> i & 1u) == 0 : (choice >> kQuick & 7u) == i - kQuick + 1;
}

std::optional<std::string> answer(std::string (*question)(const fs::path& folder)) {
  std::string text;
  const auto outcome = fuzzing::reads({}, "", [&] { text = question(runs().folder); });
  return outcome == fuzzing::Outcome::kRead ? std::optional{text} : std::nullopt;
}

const std::vector<std::string>& sound_answers() {
  static const auto kAnswers = [] {
    std::vector<std::string> answers;
    for (const auto& question : kQuestions) answers.push_back(question(runs().folder));
    return answers;
  }();
  return kAnswers;
}

}  // namespace

const fuzzing::Form fuzzing::kForm{.head_bytes = 1, .width = fuzzing::kEditSize};

// The first byte chooses what is asked and whether the manifest is made to match.
fuzzing::Outcome fuzzing::run(std::string_view input) {
  const auto& answers = sound_answers();
  fuzzing::Bytes bytes{input};
  const auto choice = bytes.byte();
  const bool forged = (choice & 0x80u) != 0;
  auto content = fuzzing::edited(runs().sound, runs().foreign, bytes);
  if (forged) content = fuzzing::with_matching_manifest(std::move(content));
  fuzzing::put(runs().folder, content);
  bool all_answered = true;
  for (std::size_t i = 0; i < kQuestions.size(); ++i) {
    if (!is_asked(choice, i)) continue;
    const auto text = answer(kQuestions.at(i));
    all_answered = all_answered && text.has_value();
    require(forged || !text || *text == answers.at(i), "an answer is that of the untouched folder, or an error",
            "question " + std::to_string(i));
  }
  fuzzing::put(runs().folder, runs().sound);
  return all_answered ? Outcome::kRead : Outcome::kRefused;
}
