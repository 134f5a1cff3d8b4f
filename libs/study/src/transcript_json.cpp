#include "kith/study/transcript_json.hpp"
#include "kith/domains/file_units.hpp"

#include <nlohmann/json.hpp>

#include "kith/explain/words.hpp"
#include "kith/study/session_forecasts.hpp"

namespace kith {
namespace {

class Converter {
 public:
  Converter(const Atlas& atlas, const Transcript& transcript)
      : atlas_{atlas}, domain_{atlas.domain()}, d_{domain_.num_features()}, transcript_{transcript} {}

  Json document() {
    const auto& record = transcript_.record;
    Json learners = Json::array();
    for (const auto& learner : record.learners) learners.push_back(to_json(learner));
    Json sessions = Json::array();
    for (const auto& session : transcript_.sessions) sessions.push_back(to_json(session));
    Json document{{"schema", "kith.teach/1"},
                  {"domain", domain_.id()},
                  {"study", transcript_.spec.id},
                  {"strategy", transcript_.address.strategy},
                  {"composition", transcript_.address.composition},
                  {"replicate", transcript_.address.replicate},
                  {"seed_address", record.seed_address},
                  {"learners", learners},
                  {"sessions", sessions},
                  {"completed", record.completed()},
                  {"status", name_of(record.status)},
                  {"periods", record.periods},
                  {"demonstrations", record.demonstrations},
                  {"tests", record.tests},
                  {"knowledge", record.knowledge},
                  {"knowledge_min", record.knowledge_min}};
    if (!transcript_.imagined.empty()) document["forecast"] = forecast();
    return document;
  }

 private:
  [[nodiscard]] Json to_json(const LearnerRecord& learner) const {
    const auto& type = learner_type(transcript_.spec, learner.type);
    Json result{{"member", learner.member},
                {"type", std::string{learner.type}},
                {"label", type.label},
                {"kind", type.model->kind}};
    for (std::size_t i = 0; i < learner.traits.size(); ++i) {
      result[std::string{type.model->traits[i].name}] = learner.traits[i];
    }
    result["parameters"] = to_json(type.parameters);
    result["p_bec"] = learner.p_bec;
    result["tests"] = learner.tests;
    result["correct"] = learner.correct;
    return result;
  }

  [[nodiscard]] static Json to_json(const ParameterValues& values) {
    Json result = Json::object();
    for (std::size_t i = 0; i < values.values().size(); ++i) {
      auto& value = result[std::string{values.declared()[i].name}];
      std::visit([&](const auto& one) { assign(value, one); }, values.values()[i]);
    }
    return result;
  }
  template <typename Value>
  static void assign(Json& json, const Value& value) {
    json = value;
  }
  static void assign(Json& json, const Spread& spread) {
    json = Json::object();
    if (spread.half_normal) json["half_normal"] = *spread.half_normal;
    if (spread.value) json["value"] = *spread.value;
  }

  [[nodiscard]] Json to_json(const TranscriptSession& session) {
    members_ = session.members;
    Json periods = Json::array();
    for (const auto& period : session.periods) periods.push_back(to_json(period));
    Json components = Json::array();
    for (const auto status : session.components) {
      components.push_back(status == ComponentStatus::kLearned   ? "learned"
                           : status == ComponentStatus::kSkipped ? "skipped"
                                                                 : "open");
    }
    return {{"members", session.members},
            {"periods", periods},
            {"status", name_of(session.status)},
            {"components", components}};
  }

  [[nodiscard]] Json to_json(const TranscriptPeriod& period) const {
    const auto& lesson = period.lesson;
    Json demonstrations = Json::array();
    for (const auto& shown : lesson.demonstrations) {
      auto demonstration = path_to_json(shown.start);
      demonstration["conveys"] = kith::to_json(shown.half_spaces, d_);
      demonstration["gain"] = shown.gain;
      demonstration["new_constraints"] = shown.num_new;
      demonstrations.push_back(std::move(demonstration));
    }
    Json tests = Json::array();
    for (std::size_t t = 0; t < lesson.tests.size(); ++t) {
      auto test = path_to_json(lesson.tests[t].start);
      test["covers"] = kith::to_json(lesson.tests[t].covered, d_);
      test["exact"] = lesson.tests[t].exact;
      Json answers = Json::array();
      for (std::size_t i = 0; i < members_.size(); ++i) {
        if (!period.feedback.verdicts[i].empty()) answers.push_back(answer_to_json(period, t, i));
      }
      test["answers"] = std::move(answers);
      tests.push_back(std::move(test));
    }
    Json excluded = Json::array();
    for (const auto member : period.feedback.excluded) excluded.push_back(members_[member]);
    const auto& component = atlas_.knowledge_components()[lesson.component];
    Json json{{"period", lesson.period},
              {"kc", lesson.component + 1},
              {"kc_name", component.name},
              {"source", source_name(lesson.source)},
              {"counterfactuals", lesson.demonstrations.front().counterfactuals.size()},
              {"repeats", lesson.repeats},
              {"demonstrations", demonstrations},
              {"taught", kith::to_json(lesson.taught, d_)},
              {"area_sr", lesson.area_sr},
              {"running_area_sr", lesson.running_area_sr},
              {"gain", lesson.gain},
              {"untested", lesson.untested},
              {"tests_demonstrated", lesson.tests_demonstrated},
              {"tests", tests},
              {"before", to_json(period.before)},
              {"after", to_json(period.after)},
              {"excluded", excluded},
              {"learned", period.feedback.component_learned}};
    if (!period.feedback.released.empty()) {
      Json released = Json::array();
      for (const auto member : period.feedback.released) released.push_back(members_[member]);
      json["released"] = std::move(released);
    }
    if (period.forecast) {
      json["forecast"] = {{"periods_left", period.forecast->periods_left},
                          {"done_within", period.forecast->done_within}};
    }
    return json;
  }

  // Before the first lesson; done_after[k] is the probability that everything is learned after k periods.
  [[nodiscard]] Json forecast() const {
    const auto all = forecast_remaining(transcript_.imagined, {});
    const auto ahead = forecast_of(all);
    Json done = Json::array();
    const auto most = static_cast<std::size_t>(all.periods_quantile(1.0));
    for (std::size_t k = 0; k <= most; ++k) done.push_back(all.done_within(k));
    return {{"sessions", transcript_.imagined.size()},
            {"periods", {{"mean", ahead.periods}, {"low", ahead.periods_low}, {"high", ahead.periods_high}}},
            {"minutes", {{"mean", ahead.minutes}, {"low", ahead.minutes_low}, {"high", ahead.minutes_high}}},
            {"done_after", done}};
  }

  [[nodiscard]] Json path_to_json(StartIndex start) const {
    const auto& counts = atlas_.feature_counts(start);
    Json json{{"start", start_to_json(domain_, atlas_.id(start))}};
    json.update(actions_json(domain_, atlas_.trajectory(start)));
    json["features"] = counts_to_json(domain_, counts);
    json["return"] = return_of(domain_, counts);
    return json;
  }

  [[nodiscard]] Json answer_to_json(const TranscriptPeriod& period, std::size_t t, std::size_t i) const {
    const auto& verdict = period.feedback.verdicts[i][t];
    const auto& response = period.responses[i];
    Json json{{"member", members_[i]}, {"correct", verdict.correct}};
    if (t < response.answers.size() && response.answers[t]) {
      const auto& counts = *response.answers[t];
      json["regret"] = in_file_units(domain_.weights(), verdict.regret);
      json["features"] = kith::to_json(counts);
      const auto path = response.weights
                            ? path_of_answer(atlas_, period.lesson.tests[t].start, counts, *response.weights)
                            : std::nullopt;
      if (path) json.update(actions_json(domain_, *path));
    }
    json["shows"] = kith::to_json(verdict.half_spaces, d_);
    if (i < period.revised.size() && !period.revised[i].empty() && period.revised[i][t]) {
      const auto& last = period.feedback.revised[i][t];
      json["revised"] = {{"correct", last.correct},
                         {"regret", in_file_units(domain_.weights(), last.regret)},
                         {"features", kith::to_json(*period.revised[i][t])}};
    }
    return json;
  }

  [[nodiscard]] std::string source_name(const SourceBelief& source) const {
    if (!source.is_member()) return source.rule;
    return "member " + std::to_string(members_[source.member]);
  }

  [[nodiscard]] static Json to_json(const BeliefState& state) {
    Json own = Json::array();
    for (std::size_t i = 0; i < state.own.size(); ++i) {
      own.push_back(to_json(state.own[i]));
      if (state.abilities[i]) own.back()["ability"] = *state.abilities[i];
    }
    Json teacher = Json::array();
    for (const auto& figures : state.teacher) teacher.push_back(to_json(figures));
    return {{"own", own}, {"teacher", teacher}};
  }

  [[nodiscard]] static Json to_json(const BeliefFigures& figures) {
    Json result{{"whose", figures.whose}, {"p_bec", figures.p_bec}, {"p_taught", figures.p_taught}};
    if (figures.ess) result["ess"] = *figures.ess;
    return result;
  }

  const Atlas& atlas_;
  const Domain& domain_;
  std::size_t d_;
  const Transcript& transcript_;
  std::vector<std::size_t> members_;
};

}  // namespace

Json transcript_json(const Atlas& atlas, const Transcript& transcript) {
  return Converter{atlas, transcript}.document();
}

}  // namespace kith
