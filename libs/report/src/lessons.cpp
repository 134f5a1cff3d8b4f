#include "sections.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "kith/explain/board_json.hpp"
#include "kith/explain/words.hpp"
#include "kith/files/column_names.hpp"
#include "kith/study/read_records.hpp"

namespace kith::detail {
namespace {

constexpr std::size_t kMostTeams = 300;
constexpr std::size_t kMostBytes = 900'000;  // of boards and teams, as JSON

// A period of a team, or of the member who is taught alone.
struct LessonOfPeriod {
  std::size_t component = 0;  // from 1
  std::vector<StartIndex> shown;
  std::vector<std::string> conveyed;  // "-1 0 2"
  struct Test {
    StartIndex start;
    std::map<std::size_t, bool> right;  // by member
  };
  std::map<std::size_t, Test> tests;        // by number
  std::map<std::size_t, double> knowledge;  // by member
};
using TeamLessons =
    std::map<std::pair<std::size_t, std::size_t>, LessonOfPeriod>;  // by member, 0 for a team, and period

std::vector<std::size_t> telling_first(const ReportDesign& design, const RunData& data) {
  std::vector<std::size_t> order;
  for (const auto& telling : telling_teams(design, data)) order.push_back(telling.team);
  std::vector<std::size_t> rest;
  for (std::size_t i = 0; i < data.teams.size(); ++i) {
    if (std::find(order.begin(), order.end(), i) == order.end()) rest.push_back(i);
  }
  std::stable_sort(rest.begin(), rest.end(), [&](std::size_t a, std::size_t b) {
    return data.teams[a].address.replicate < data.teams[b].address.replicate;
  });
  order.insert(order.end(), rest.begin(), rest.end());
  if (order.size() > kMostTeams) order.resize(kMostTeams);
  return order;
}

// "-1 0 2"
std::string conveyed_text(const HalfSpace& half_space) {
  return joined(half_space.normal(), " ", [](std::int64_t entry) { return std::to_string(entry); });
}

class LessonReader {
 public:
  LessonReader(const RunFiles& run, const Atlas& atlas, const std::vector<std::size_t>& teams)
      : run_{run}, atlas_{atlas} {
    for (const auto team : teams) lessons_[team];
  }

  std::map<std::size_t, TeamLessons> read() && {
    read_table<DemonstrationRecord>(
        "demonstrations.csv",
        {columns::kPeriod, columns::kComponent, columns::kMdp, columns::kStart, columns::kConstraint, columns::kMember},
        [&](const RecordRow& row, const DemonstrationRecord& demonstration, TeamLessons& team) {
          auto& lesson = lesson_of(row, demonstration, team, demonstration.member);
          lesson.shown.push_back(start_of(row, demonstration));
          for (const auto& one : demonstration.constraints) lesson.conveyed.push_back(conveyed_text(one));
        });
    read_table<ResponseRecord>(
        "responses.csv",
        {columns::kPeriod, columns::kComponent, columns::kMdp, columns::kStart, columns::kTest, columns::kMember,
         columns::kCorrect},
        [&](const RecordRow& row, const ResponseRecord& response, TeamLessons& team) {
          auto& test = lesson_of(row, response, team, session_of(row, response.member)).tests[response.test];
          test.start = start_of(row, response);
          test.right[response.member] = response.correct;
        });
    read_table<ProgressRecord>(
        "progress.csv", {columns::kPeriod, columns::kComponent, columns::kMember, columns::kBelief},
        [&](const RecordRow& row, const ProgressRecord& progress, TeamLessons& team) {
          lesson_of(row, progress, team, session_of(row, progress.member)).knowledge[progress.member] = progress.p_bec;
        });
    return std::move(lessons_);
  }

 private:
  template <typename Record, typename OnRecord>
  void read_table(const std::string& table, const std::vector<std::string_view>& wanted, OnRecord on_record) {
    const auto text = table_text(run_, table);
    read_records<Record>({text, (run_.folder / "tables" / table).string(), &run_.study, run_.teams}, wanted,
                         [&](const RecordRow& row, const Record& record) {
                           const auto team = lessons_.find(row.team);
                           if (team != lessons_.end()) on_record(row, record, team->second);
                         });
  }

  // In the baseline every member has a session.
  static std::size_t session_of(const RecordRow& row, std::size_t member) {
    return row.address.strategy == kBaseline ? member : 0;
  }

  template <typename Record>
  static LessonOfPeriod& lesson_of(const RecordRow& row, const Record& record, TeamLessons& team, std::size_t session) {
    auto& lesson = team[{session, record.period}];
    lesson.component = row.within(record.component, 1, std::numeric_limits<std::size_t>::max());
    return lesson;
  }

  template <typename Record>
  [[nodiscard]] StartIndex start_of(const RecordRow& row, const Record& record) const {
    const auto& domain = run_.domain;
    const MdpIndex mdp{row.within(record.mdp, 0, domain.num_mdps() - 1)};
    return atlas_.index({mdp, StateIndex{row.within(record.start, 0, domain.mdp(mdp).num_states() - 1)}});
  }

  const RunFiles& run_;
  const Atlas& atlas_;
  std::map<std::size_t, TeamLessons> lessons_;
};

// Boards and sentences are written once, however many teams had them.
class LessonWriter {
 public:
  explicit LessonWriter(const Atlas& atlas) : atlas_{atlas}, domain_{atlas.domain()} {}

  // Whether there was room for it.
  bool add(const TeamAddress& address, const std::string& strategy, const TeamLessons& team) {
    Json periods = Json::array();
    for (const auto& [key, lesson] : team) periods.push_back(period_json(key.first, key.second, address, lesson));
    Json json{{"team", address.team},
              {"strategy", strategy},
              {"composition", address.composition},
              {"replicate", address.replicate},
              {"periods", std::move(periods)}};
    bytes_ += json.dump().size();
    if (bytes_ > kMostBytes) return false;
    teams_.push_back(std::move(json));
    return true;
  }

  [[nodiscard]] std::size_t num_teams() const { return teams_.size(); }

  Json take() && {
    Json features = Json::array();
    for (const auto& name : domain_.feature_names()) features.push_back(name);
    return {{"domain", board_domain_json(domain_)},
            {"features", std::move(features)},
            {"boards", std::move(boards_)},
            {"sentences", std::move(sentences_)},
            {"teams", std::move(teams_)}};
  }

 private:
  // [period, component, member or 0, shown boards, conveyed sentences, [[board, "10-"]], [knowledge in hundredths]]
  Json period_json(std::size_t session, std::size_t period, const TeamAddress& address, const LessonOfPeriod& lesson) {
    Json shown = Json::array(), says = Json::array(), tests = Json::array(), knowledge = Json::array();
    for (const auto start : lesson.shown) shown.push_back(board(start));
    for (const auto& normal : lesson.conveyed) says.push_back(sentence(normal));
    const auto first = session == 0 ? std::size_t{1} : session,
               last = session == 0 ? address.composition.size() : session;
    for (const auto& [number, test] : lesson.tests) {
      std::string right;
      for (auto member = first; member <= last; ++member) {
        const auto found = test.right.find(member);
        right += found == test.right.end() ? '-' : found->second ? '1' : '0';
      }
      tests.push_back(Json::array({board(test.start), right}));
    }
    for (auto member = first; member <= last; ++member) {
      const auto found = lesson.knowledge.find(member);
      knowledge.push_back(found == lesson.knowledge.end() ? Json(nullptr) : Json(std::lround(100.0 * found->second)));
    }
    return Json::array(
        {period, lesson.component, session, std::move(shown), std::move(says), std::move(tests), std::move(knowledge)});
  }

  std::size_t board(StartIndex start) {
    const auto [entry, is_new] = known_boards_.emplace(start, boards_.size());
    if (is_new) {
      const auto id = atlas_.id(start);
      const auto path = atlas_.trajectory(start);
      auto json = board_json(domain_, id);
      json.update(path_json(domain_, id.mdp, path));
      json["text"] = actions_text(domain_, id.mdp, path);
      bytes_ += json.dump().size();
      boards_.push_back(std::move(json));
    }
    return entry->second;
  }

  std::size_t sentence(const std::string& normal) {
    const auto [entry, is_new] = known_sentences_.emplace(normal, sentences_.size());
    if (is_new) {
      IntegerVector vector(domain_.num_features());
      std::istringstream stream{normal};
      Json numbers = Json::array();
      for (std::size_t k = 0; k < vector.size(); ++k) {
        std::int64_t value = 0;
        stream >> value;
        vector[k] = value;
        numbers.push_back(value);
      }
      sentences_.push_back({{"normal", std::move(numbers)}, {"text", in_words(domain_, HalfSpace{vector})}});
    }
    return entry->second;
  }

  const Atlas& atlas_;
  const Domain& domain_;
  Json boards_ = Json::array(), sentences_ = Json::array(), teams_ = Json::array();
  std::map<StartIndex, std::size_t> known_boards_;
  std::map<std::string, std::size_t> known_sentences_;
  std::size_t bytes_ = 0;
};

}  // namespace

std::optional<Json> team_lessons(const RunFiles& run, const ReportDesign& design, const RunData& data,
                                 const Atlas& atlas, std::vector<std::string>& notes) {
  if (!data.has_periods) return std::nullopt;
  const auto order = telling_first(design, data);
  const auto lessons = LessonReader{run, atlas, order}.read();
  LessonWriter writer{atlas};
  for (const auto team : order) {
    const auto& series = design.series[design.cells[design.cell_of_team[team]].series];
    if (!writer.add(run.teams[team], series.code, lessons.at(team))) break;
  }
  if (writer.num_teams() == 0) return std::nullopt;
  if (writer.num_teams() < data.teams.size()) {
    notes.push_back("The lessons of " + std::to_string(writer.num_teams()) + " of " +
                    std::to_string(data.teams.size()) +
                    " teams are in this report: telling ones, then the first replicates of every cell. 'kith teach "
                    "--from' replays any other.");
  }
  return std::move(writer).take();
}

}  // namespace kith::detail
