#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <map>
#include <set>

#include "domain_texts.hpp"
#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/fit/answer_regions.hpp"
#include "kith/fit/fit.hpp"
#include "kith/fit/import_logs.hpp"
#include "resealed.hpp"
#include "simulated_people.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

const std::string kTypes =
    "[learner.N]\nability = { mean = 0.62, sd = 0.01, min = 0.55 }\nconfirm_gain = { value = 0.0 }\n"
    "correct_gain = { value = 0.02 }\nparticles = 50\n[stop]\nmax_periods = 4\n";

// "E0708 responses.csv:3", or "none".
std::string fault_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& error) {
    if (error.diagnostics().empty()) return error.what();
    const auto& first = error.diagnostics().front();
    return first.id + " " + fs::path{first.file}.filename().string() + ":" + std::to_string(first.line);
  }
  return "none";
}

std::string import_fault(const fs::path& path) {
  return fault_of([&] { static_cast<void>(import_logs({path}, AnswerDetail::kPath)); });
}

class RunFolderImport : public ::testing::Test {
 protected:
  void SetUp() override { testing::run_into(run_, testing::study_text("NN", 2, kTypes)); }

  // Replaces the first occurrence in a table.
  void spoil(const std::string& table, const std::string& from, const std::string& to) {
    const auto path = run_ / "tables" / table;
    auto text = read_file(path);
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    put_table(table, text.replace(at, from.size(), to));
  }
  // As if the run had written it.
  void put_table(const std::string& table, const std::string& text) {
    write_file_atomically(run_ / "tables" / table, text);
    testing::reseal(run_);
  }

  testing::ScratchFolder folder_;
  fs::path run_ = folder_.path() / "run";
};

TEST_F(RunFolderImport, ReadsEverybodyWithTheirPeriods) {
  const auto logs = import_logs({run_}, AnswerDetail::kPath);
  ASSERT_EQ(logs.people.size(), 4u);
  EXPECT_EQ(logs.people[0].id, "1/1");
  EXPECT_EQ(logs.people[3].id, "2/2");
  EXPECT_TRUE(logs.notes.empty());
  for (const auto& person : logs.people) {
    EXPECT_EQ(person.type, "N");
    EXPECT_FALSE(person.periods.empty());
    EXPECT_EQ(num_particles(logs.models.at(person.model).parameters), 50u);
    std::size_t answers = 0;
    for (const auto& period : person.periods) {
      EXPECT_FALSE(period.conveyed.empty());
      EXPECT_TRUE(period.feedback);
      answers += period.answers.size();
    }
    EXPECT_EQ(answers, person.answered);
  }
}

TEST_F(RunFolderImport, PutsSeveralRunsTogether) {
  const auto other = folder_.path() / "other";
  testing::run_into(other, testing::study_text("N", 3, kTypes));
  const auto logs = import_logs({run_, other}, AnswerDetail::kVerdict);
  ASSERT_EQ(logs.people.size(), 7u);
  EXPECT_EQ(logs.people[0].id, "1:1/1");
  EXPECT_EQ(logs.people[6].id, "2:3/1");
  EXPECT_EQ(logs.models.size(), 2u);
  EXPECT_EQ(logs.people[6].model, 1u);
}

TEST_F(RunFolderImport, NamesFileAndRowOfWhatItCannotRead) {
  const auto answers = read_file(run_ / "tables" / "responses.csv");
  spoil("responses.csv", ",correct,", ",verdict,");
  EXPECT_EQ(import_fault(run_), "E0502 responses.csv:1");
  put_table("responses.csv", answers);
  spoil("responses.csv", "\ncommon,NN,1,1,1", "\ncommon,NN,1,1,one");
  EXPECT_EQ(import_fault(run_), "E0506 responses.csv:2");
  put_table("responses.csv", answers);
  spoil("responses.csv", "\ncommon,NN,1,1,", "\ncommon,NN,1,77,");
  EXPECT_EQ(import_fault(run_), "E0620 responses.csv:2");
}

TEST_F(RunFolderImport, RefusesCellsThatAreNoHalfSpaces) {
  spoil("demonstrations.csv", "-1 0", "-1 zero");
  EXPECT_EQ(import_fault(run_).substr(0, 24), "E0621 demonstrations.csv");
}

TEST_F(RunFolderImport, RefusesAnUnknownType) {
  spoil("learners.csv", ",1,1,1,N,", ",1,1,1,X,");
  EXPECT_EQ(import_fault(run_), "E0708 learners.csv:2");
}

TEST_F(RunFolderImport, RefusesTablesThatWereChanged) {
  write_file_atomically(run_ / "tables" / "responses.csv", read_file(run_ / "tables" / "responses.csv") + "\n");
  EXPECT_EQ(import_fault(run_), "E0607 responses.csv:0");
}

TEST_F(RunFolderImport, RefusesARunThatIsNotFinished) {
  fs::remove(run_ / "manifest.json");
  EXPECT_EQ(import_fault(run_), "E0704 run:0");
}

TEST_F(RunFolderImport, RefusesARunWithoutAnswers) {
  const auto answers = read_file(run_ / "tables" / "responses.csv");
  put_table("responses.csv", answers.substr(0, answers.find('\n') + 1));
  EXPECT_EQ(import_fault(run_), "E0705 responses.csv:0");
}

TEST_F(RunFolderImport, CountsAPathThatIsBestForNobodyByItsVerdict) {
  auto text = read_file(run_ / "tables" / "responses.csv");
  std::string spoiled;
  for (std::size_t begin = 0; begin < text.size();) {
    const auto end = text.find('\n', begin);
    auto line = text.substr(begin, end - begin);
    if (begin > 0) {  // the thirteenth cell is the answer
      std::size_t at = 0;
      for (int comma = 0; comma < 12; ++comma) at = line.find(',', at) + 1;
      line.replace(at, line.find(',', at) - at, "9 9 99");
    }
    spoiled += line + "\n";
    begin = end + 1;
  }
  put_table("responses.csv", spoiled);
  const auto logs = import_logs({run_}, AnswerDetail::kPath);
  ASSERT_EQ(logs.notes.size(), 1u);
  EXPECT_EQ(logs.notes[0].id, "W0706");
}

TEST_F(RunFolderImport, CountsTestsWithoutAnAnswerAsSayingNothing) {
  spoil("responses.csv", "0 ", "");
  auto text = read_file(run_ / "tables" / "responses.csv");
  const auto row = text.find('\n') + 1;
  std::size_t at = row;
  for (int comma = 0; comma < 12; ++comma) at = text.find(',', at) + 1;
  text.replace(at, text.find(',', at) - at, "");
  put_table("responses.csv", text);
  const auto logs = import_logs({run_}, AnswerDetail::kPath);
  ASSERT_FALSE(logs.notes.empty());
  EXPECT_EQ(logs.notes.back().id, "W0707");
}

TEST(RunImport, RefusesRecordsOfTeamsOnlyAndCounterfactualsOfPeoplesOwn) {
  const testing::ScratchFolder folder;
  testing::run_into(folder.path() / "teams", testing::study_text("N", 2, kTypes + "[record]\nlevel = \"team\"\n"));
  EXPECT_EQ(import_fault(folder.path() / "teams"), "E0705 study.toml:0");
  testing::run_into(folder.path() / "own",
                    testing::study_text("N", 2, kTypes + "[teacher]\nlearner_counterfactuals = \"self\"\n"));
  EXPECT_EQ(import_fault(folder.path() / "own"), "E0706 study.toml:0");
}

TEST(RunImport, RefusesPeopleWhoWereNotTaughtAllTheTime) {
  const testing::ScratchFolder folder;
  testing::run_into(folder.path() / "released", testing::study_text("NN", 2, kTypes + "release = \"all-right\"\n"));
  EXPECT_EQ(import_fault(folder.path() / "released"), "E0713 study.toml:0");
}

// The same people under another name: which parameters another model has is not known here.
TEST(RunImport, RefusesLearnersOfOtherModels) {
  LearnerModel other = bayesian_model();
  other.kind = "other";
  const std::array<const LearnerModel*, 1> models{&other};
  const testing::ScratchFolder folder;
  testing::run_into(folder.path() / "run", testing::study_text("N", 2, kTypes), {.learners = models});
  try {
    (void)import_run_folder(folder.path() / "run", AnswerDetail::kPath, {.learners = models});
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    ASSERT_EQ(error.diagnostics().size(), 1u);
    EXPECT_EQ(error.diagnostics().front().id, "E0712");
  }
}

TEST(RunImport, WarnsOfPeopleWhoAreInSeveralTeams) {
  const testing::ScratchFolder folder;
  testing::run_into(
      folder.path() / "run",
      "schema = \"kith.study/1\"\nid = \"paired\"\ndomain = \"item-delivery\"\nseed = 3\nreplicates = 2\n[design]\n"
      "strategies = [\"baseline\", \"common\"]\ncompositions = [\"NN\"]\n" +
          kTypes);
  const auto logs = import_logs({folder.path() / "run"}, AnswerDetail::kPath);
  EXPECT_EQ(logs.people.size(), 8u);
  for (const auto& person : logs.people) EXPECT_FALSE(person.periods.empty()) << person.id;
  ASSERT_EQ(logs.notes.size(), 1u);
  EXPECT_EQ(logs.notes[0].id, "W0704");
}

TEST(ImportLogs, RefusesWhatItDoesNotKnow) {
  const testing::ScratchFolder folder;
  EXPECT_EQ(import_fault(folder.path()).substr(0, 5), "E0703");
  EXPECT_EQ(import_fault(folder.write("a.csv", "team,score\n1,2\n")), "E0703 a.csv:1");
  EXPECT_EQ(import_fault(folder.write("b.csv", "")), "E0501 b.csv:1");
  EXPECT_NE(import_fault(folder.path() / "nowhere").find("nowhere"), std::string::npos);
}

// Rows of our own in the layout of the studies with one row per trial.
constexpr const char* kHeader =
    "user_id,loop_condition,domain,interaction_type,iteration,is_opt_response,mdp_parameters\n";
constexpr const char* kToll =
    R"("{""constraints"": [[[-1, 0, 2.0]]], ""variable_filter"": [0, 1, 0], ""prior"": [0, 0, -1]}")";

std::string row(const std::string& who, const std::string& condition, const std::string& what,
                const std::string& right) {
  return who + "," + condition + ",at," + what + ",0," + right + "," + kToll + "\n";
}

std::string session(const std::string& who, const std::string& condition, std::size_t finals) {
  std::string text = row(who, condition, "demo", "") + row(who, condition, "diagnostic test", "0") +
                     row(who, condition, "diagnostic feedback", "") + row(who, condition, "remedial demo", "") +
                     row(who, condition, "remedial test", "1");
  for (std::size_t i = 0; i < finals; ++i) text += row(who, condition, "final test", i % 2 == 0 ? "1" : "True");
  return text;
}

std::multiset<std::string> note_ids(const ResponseLogs& logs) {
  std::multiset<std::string> ids;
  for (const auto& note : logs.notes) ids.insert(note.id);
  return ids;
}

TEST(Trials, BecomePeriodsInOrder) {
  const testing::ScratchFolder folder;
  const auto logs = import_trials(folder.write("trials.csv", kHeader + session("a", "cl", 2)));
  ASSERT_EQ(logs.people.size(), 1u);
  const auto& person = logs.people[0];
  EXPECT_EQ(person.id, "a/at");
  EXPECT_EQ(person.answered, 4u);
  EXPECT_EQ(person.correct, 3u);
  ASSERT_EQ(person.periods.size(), 4u);
  const std::vector<HalfSpace> shown{HalfSpace{IntegerVector{-1, 0, 2}}};
  EXPECT_EQ(person.periods[0].conveyed, shown);
  EXPECT_FALSE(person.periods[0].all_correct);
  EXPECT_TRUE(person.periods[0].feedback);
  EXPECT_EQ(person.periods[0].taught, shown);
  EXPECT_TRUE(person.periods[1].feedback);  // a right answer whose feedback row is missing
  EXPECT_FALSE(person.periods[2].feedback);
  EXPECT_TRUE(person.periods[3].conveyed.empty());
  EXPECT_EQ(note_ids(logs), std::multiset<std::string>{"W0703"});
}

TEST(Trials, KnownFaultsAreNotedAndNothingIsDroppedInSilence) {
  const testing::ScratchFolder folder;
  const std::string text = kHeader + session("a", "cl", 12) + session("b", "cl", 12) + session("c", "cl", 11) +
                           session("d", "open", 12) + session("e", "wt", 12) + row("f", "cl", "demo", "") +
                           row("f", "cl", "diagnostic test", "0") + row("f", "open", "final test", "0");
  const auto logs = import_trials(folder.write("trials.csv", text));
  EXPECT_EQ(logs.people.size(), 5u);
  EXPECT_EQ(note_ids(logs), (std::multiset<std::string>{"W0701", "W0701", "W0701", "W0702", "W0702", "W0703", "W0703",
                                                        "W0703", "W0703", "W0705"}));
  for (const auto& note : logs.notes) {
    EXPECT_EQ(note.severity, Severity::kWarning);
    EXPECT_GT(note.line, 0u);
  }
}

TEST(Trials, CanBeFitted) {
  const testing::ScratchFolder folder;
  std::string text = kHeader;
  for (const char who : {'a', 'b', 'c', 'd'}) text += session(std::string{who}, "cl", 4);
  const auto imported = import_logs({folder.write("trials.csv", text)}, AnswerDetail::kPath);
  FitOptions options{.replicates = 1};
  options.num_abilities = 5;
  options.num_gains = 3;
  options.num_draws = 10;
  options.folds = 0;
  const auto report = fit_learners(imported, options);
  ASSERT_EQ(report.types.size(), 1u);
  EXPECT_EQ(report.types[0].name, "all");
  EXPECT_EQ(report.people.size(), 4u);
}

// Somebody who hears of mud, then of the recharge station, and the numbers of whose constraints stand in this order.
std::string rows_of(const std::string& who, const std::array<std::size_t, 3>& order, std::size_t right) {
  std::string text;
  const auto add = [&](const std::string& what, std::array<int, 3> normal, const std::string& verdict) {
    const auto in_order = [&](const std::array<int, 3>& v) {
      return "[[" + std::to_string(v[order[0]]) + ", " + std::to_string(v[order[1]]) + ", " +
             std::to_string(v[order[2]]) + "]]";
    };
    text += who + ",cl,at," + what + ",0," + verdict + ",\"{\"\"constraints\"\": " + in_order(normal) +
            ", \"\"prior\"\": " + in_order({0, 0, -1}) + "}\"\n";
  };
  std::size_t test = 0;
  for (const auto& normal : {std::array{-1, 0, 2}, std::array{1, 0, -4}, std::array{0, 1, 4}}) {
    add("demo", normal, "");
    add("diagnostic test", normal, (right >> test++ & 1) == 1 ? "1" : "0");
    add("diagnostic feedback", normal, "");
    add("final test", normal, (right >> test++ & 1) == 1 ? "1" : "0");
  }
  return text;
}

std::map<std::string, double> abilities(const FitReport& report) {
  std::map<std::string, double> result{{"", report.types.at(0).median.ability_mean}};
  for (const auto& person : report.people) result[person.id] = person.posterior.ability.mean;
  return result;
}

// What people are called, in which files and in which order they come, decides nothing; nor does the order of features,
// but for other random numbers.
TEST(Trials, AreFittedWhateverTheirOrderNamesAndFiles) {
  const testing::ScratchFolder folder;
  const std::vector<std::size_t> answers{63, 42, 21, 62, 40, 31};
  const auto fitted = [&](const std::vector<std::string>& texts) {
    std::vector<fs::path> files;
    for (const auto& text : texts)
      files.push_back(folder.write("t" + std::to_string(files.size()) + ".csv", kHeader + text));
    const auto logs = import_logs(files, AnswerDetail::kPath);
    EXPECT_EQ(note_ids(logs).count("W0708"), 0u);
    const FitOptions options{.replicates = 32, .folds = 0, .num_abilities = 5, .num_gains = 2, .num_draws = 20};
    return abilities(fit_learners(logs, options));
  };
  const auto text_of = [&](std::size_t from, std::size_t to, const std::array<std::size_t, 3>& order, bool renamed) {
    std::string text;
    for (std::size_t i = from; i < to; ++i)
      text += rows_of(std::string(1, static_cast<char>(renamed ? 'z' - i : 'a' + i)), order, answers[i]);
    return text;
  };
  const std::array<std::size_t, 3> usual{0, 1, 2}, step_first{2, 0, 1};
  const auto as_is = fitted({text_of(0, 6, usual, false)});
  const auto renamed = fitted({text_of(0, 6, usual, true)});
  const auto split = fitted({text_of(3, 6, usual, false), text_of(0, 3, usual, false)});
  const auto turned = fitted({text_of(0, 6, step_first, false)});
  EXPECT_EQ(as_is.at(""), renamed.at(""));
  EXPECT_EQ(as_is.at(""), split.at(""));
  EXPECT_NEAR(as_is.at(""), turned.at(""), 0.02);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const auto who = std::string(1, static_cast<char>('a' + i)) + "/at";
    EXPECT_EQ(as_is.at(who), renamed.at(std::string(1, static_cast<char>('z' - i)) + "/at")) << who;
    EXPECT_EQ(as_is.at(who), split.at((i < 3 ? "2:" : "1:") + who)) << who;
    EXPECT_NEAR(as_is.at(who), turned.at(who), 0.02) << who;
  }
}

TEST(Trials, SayWhatPeopleKnowBeforehand) {
  const testing::ScratchFolder folder;
  const auto read = [&](const std::string& domain, const std::string& shown, const std::string& parameters = "") {
    return import_trials(
        folder.write("t.csv", kHeader + ("a,open," + domain + ",demo,0,,\"{\"\"constraints\"\": [" + shown + "]" +
                                         parameters + "}\"\na,open," + domain + ",final test,0,1,\n")));
  };
  const auto given = read("at", "[2, -1, 0]", ", \"\"prior\"\": [[-1, 0, 0], [0, -1, 0]]");
  const std::vector known{HalfSpace{IntegerVector{-1, 0, 0}}, HalfSpace{IntegerVector{0, -1, 0}}};
  EXPECT_EQ(given.models.at(0).prior, *Cone::intersection(known));
  EXPECT_EQ(note_ids(given), std::multiset<std::string>{});
  EXPECT_EQ(note_ids(read("at", "[2, -1, 0]")), std::multiset<std::string>{"W0708"});  // the last, and that is said
  EXPECT_EQ(note_ids(read("item-delivery", "[-1, 0, 2]")), std::multiset<std::string>{});
  const auto fault = [&](const auto&... cells) { return fault_of([&] { static_cast<void>(read(cells...)); }); };
  EXPECT_EQ(fault("item-delivery", "[2, -1, 0]"), "E0707 t.csv:2");  // not in the order of that domain
  EXPECT_EQ(fault("at", "[2, -1, 0]", ", \"\"prior\"\": [[0.5, 0, 1]]"), "E0707 t.csv:2");
  EXPECT_EQ(fault("at", "[2, -1, 0]", ", \"\"prior\"\": [[0, 1]]"), "E0707 t.csv:2");
  EXPECT_EQ(fault("at", "[2, -1, 0]", ", \"\"prior\"\": [[1, 0, 0], [-1, 0, 0]]"), "E0707 t.csv:2");
}

TEST(Trials, NameRowAndFaultOfWhatCannotBeRead) {
  const testing::ScratchFolder folder;
  const auto fault = [&](const std::string& text) { return import_fault(folder.write("t.csv", text)); };
  const std::string good = session("a", "cl", 1);
  EXPECT_EQ(fault(kHeader + good), "none");
  EXPECT_EQ(fault("user_id,domain,is_opt_response\na,at,1\n"), "E0502 t.csv:1");
  EXPECT_EQ(fault(kHeader + good + row("a", "cl", "final tests", "1")), "E0709 t.csv:8");
  EXPECT_EQ(fault(kHeader + row("a", "loop", "demo", "")), "E0709 t.csv:2");
  EXPECT_EQ(fault(kHeader + row("a", "cl", "final test", "maybe")), "E0709 t.csv:2");
  EXPECT_EQ(fault(kHeader + std::string{"a,cl,at,demo,0,,{\n"}), "E0707 t.csv:2");
  EXPECT_EQ(fault(kHeader + std::string{"a,cl,at,demo,0,,\"{\"\"constraints\"\": [[0.5, 0, 1]]}\"\n"}),
            "E0707 t.csv:2");
  EXPECT_EQ(fault(kHeader + std::string{"a,cl,at\n"}), "E0505 t.csv:2");
}

TEST(Trials, SayWhatTypeALearnerIsOf) {
  const testing::ScratchFolder folder;
  const std::string header = "user_id,domain,interaction_type,is_opt_response,learner_type\n";
  const auto read = [&](const std::string& rows) { return import_trials(folder.write("t.csv", header + rows)); };
  const auto logs = read("a,at,demo,,N\na,at,final test,1,\nb,at,demo,,P\nb,at,final test,0,P\n");
  ASSERT_EQ(logs.people.size(), 2u);
  EXPECT_EQ(logs.people[0].type, "N");
  EXPECT_EQ(logs.people[1].type, "P");
  EXPECT_EQ(import_fault(folder.write("t.csv", header + "a,at,demo,,N\na,at,final test,1,P\n")), "E0709 t.csv:3");
}

// As Excel saves a sheet in countries with a decimal comma, and as pandas writes truth.
TEST(Trials, AreReadInTheDialectsOfSpreadsheets) {
  const testing::ScratchFolder folder;
  const std::string rows =
      "user_id;domain;interaction_type;is_opt_response;mdp_parameters\r\n"
      "\"1\";at;demo;;\"{\"\"constraints\"\": [[-1, 0, 2]]}\"\r\n\"1\";at;diagnostic test;TRUE;\r\n"
      "1;at;final test;False;\r\n1;at;final test;\"1\";\r\n";
  const auto logs = import_trials(folder.write("t.csv", "\xEF\xBB\xBF" + rows));
  ASSERT_EQ(logs.people.size(), 1u);
  EXPECT_EQ(logs.people[0].answered, 3u);
  EXPECT_EQ(logs.people[0].correct, 2u);
}

TEST(Trials, ListTheWordsThatAreKnown) {
  const testing::ScratchFolder folder;
  try {
    static_cast<void>(import_trials(folder.write("t.csv", kHeader + row("a", "cl", "test", "1"))));
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(error.diagnostics().at(0).hint.find("final test"), std::string::npos);
    EXPECT_NE(error.diagnostics().at(0).hint.find("diagnostic feedback"), std::string::npos);
  }
}

// Going through lists in lists in lists would use up the stack.
TEST(Trials, AreRefusedWithListsNestedTooDeep) {
  const testing::ScratchFolder folder;
  const auto nested = [](std::size_t depth) { return std::string(depth, '[') + "1, 0, 2" + std::string(depth, ']'); };
  const auto fault = [&](const std::string& key, std::size_t depth) {
    const auto cell = "\"{\"\"" + key + "\"\": " + nested(depth) + "}\"";
    return import_fault(folder.write("t.csv", kHeader + ("a,cl,at,demo,0,," + cell + "\n") + session("a", "cl", 1)));
  };
  for (const std::string key : {"constraints", "variable_filter"}) {
    EXPECT_EQ(fault(key, 3), "none");
    EXPECT_EQ(fault(key, 200'000), "E0707 t.csv:2");
  }
}

TEST(Trials, GiveDifferentPeopleDifferentNames) {
  const testing::ScratchFolder folder;
  const std::string text =
      "user_id,domain,interaction_type,is_opt_response,group\n"
      "a,b/c,final test,1,\n"
      "a/b,c,final test,1,\n"
      "b,c,final test,1,a\n";
  const auto logs = import_trials(folder.write("t.csv", text));
  std::set<std::string> names;
  for (const auto& person : logs.people) names.insert(person.id);
  EXPECT_EQ(names, (std::set<std::string>{"a/b%2Fc", "a%2Fb/c", "a/b/c"}));
}

}  // namespace
}  // namespace kith
