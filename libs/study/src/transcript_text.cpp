#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "kith/domains/file_units.hpp"
#include "kith/explain/picture.hpp"
#include "kith/explain/words.hpp"
#include "kith/explain/wrapped.hpp"
#include "kith/study/session_forecasts.hpp"
#include "kith/study/transcript.hpp"

namespace kith {
namespace {

// Writes a transcript from top to bottom.
class TranscriptWriter {
 public:
  TranscriptWriter(const Atlas& atlas, const Transcript& transcript)
      : atlas_{atlas}, domain_{atlas.domain()}, transcript_{transcript} {}

  std::string text() {
    out_ = transcript_header(atlas_, transcript_);
    if (!transcript_.imagined.empty()) forecast();
    for (const auto& session : transcript_.sessions) write(session);
    ending();
    return std::move(out_);
  }

 private:
  void line(const std::string& text = "") { out_ += wrapped_line(text) + "\n"; }

  void write(const TranscriptSession& session) {
    members_ = session.members;
    if (transcript_.sessions.size() > 1) {
      line();
      line(std::string(kTextWidth, '#'));
      line(session.members.size() == 1 ? fmt::format("Session of member {} alone", session.members.front())
                                       : fmt::format("Session of members {}", fmt::join(session.members, ", ")));
    }
    skipped_until(session, 0,
                  session.periods.empty() ? session.components.size() : session.periods.front().lesson.component);
    for (std::size_t i = 0; i < session.periods.size(); ++i) {
      const bool begins = i > 0 && session.periods[i].lesson.component != session.periods[i - 1].lesson.component;
      write(session.periods[i], begins);
      const auto next =
          i + 1 < session.periods.size() ? session.periods[i + 1].lesson.component : session.components.size();
      skipped_until(session, session.periods[i].lesson.component + 1, next);
    }
    if (transcript_.sessions.size() == 1) return;  // then the end of the transcript says it
    line();
    line(summary(session) + ".");
  }

  [[nodiscard]] static std::string summary(const TranscriptSession& session) {
    const auto count = [&](ComponentStatus status) {
      return std::count(session.components.begin(), session.components.end(), status);
    };
    const auto skipped = count(ComponentStatus::kSkipped);
    return fmt::format("{} {}: {} of {} knowledge components learned{}",
                       session.status == SessionStatus::kMaxPeriods ? "Stopped at the limit of"
                       : session.status == SessionStatus::kSkipped  ? "Nothing else to show after"
                                                                    : "Complete after",
                       counted(session.periods.size(), "period"), count(ComponentStatus::kLearned),
                       session.components.size(), skipped > 0 ? fmt::format(", {} skipped", skipped) : "");
  }

  void skipped_until(const TranscriptSession& session, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < std::min(last, session.components.size()); ++i) {
      if (session.components[i] != ComponentStatus::kSkipped) continue;
      line();
      line(fmt::format("Knowledge component {} is skipped: nothing left to teach.", i + 1));
    }
  }

  // `begins`: the first period of a component that is not the first of the session.
  void write(const TranscriptPeriod& period, bool begins) {
    const auto& lesson = period.lesson;
    const auto& component = atlas_.knowledge_components()[lesson.component];
    line();
    line(std::string(kTextWidth, '='));
    line(fmt::format("Period {}: knowledge component {}, {}", lesson.period, lesson.component + 1, component.name));
    line("  weighs " + weighed(component) +
         (component.masked.empty() ? "" : ", where there is no " + masked_names(domain_, component)));
    if (begins) line("  new component: every member's ability is reset to its initial value");
    reason(lesson);
    for (std::size_t i = 0; i < lesson.demonstrations.size(); ++i)
      demonstration(i + 1, lesson.demonstrations[i], lesson.source.is_everybody());
    taught(lesson);
    for (std::size_t t = 0; t < lesson.tests.size(); ++t) test(period, t);
    beliefs(period);
    conclusion(period, begins);
  }

  [[nodiscard]] std::string weighed(const KnowledgeComponent& component) const {
    std::string text;
    std::vector<std::string> names;
    for (std::size_t k = 0; k < domain_.num_features(); ++k) {
      if (std::find(component.masked.begin(), component.masked.end(), k) == component.masked.end())
        names.push_back(domain_.feature_words(k));
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto left = names.size() - i;  // the last stands against the others
      text += (i == 0 ? "" : left == 1 ? " against " : left == 2 ? " and " : ", ") + names[i];
    }
    return text;
  }

  [[nodiscard]] std::string name_of_source(const SourceBelief& source) const {
    if (source.is_everybody()) return "the beliefs about all members";
    if (!source.is_member()) {
      const auto* rule = find_aggregation_rule(source.rule);
      return "the " + source.rule + " belief" + (rule != nullptr ? ": " + std::string{rule->description} : "");
    }
    return fmt::format("the belief about member {}", members_[source.member]);
  }

  void reason(const Lesson& lesson) {
    line("  lesson chosen for " + name_of_source(lesson.source));
    if (lesson.repeats) {
      line("  no demonstration would teach anything new: the last lesson is repeated");
    } else {
      const auto& shown = lesson.demonstrations;
      const auto ways = shown.front().counterfactuals.size();
      if (!shown.front().completes) {
        line(fmt::format("  {} simulated people with that belief would act in {}",
                         transcript_.spec.teaching.counterfactuals,
                         ways == 1 ? "one way" : fmt::format("{} different ways", ways)));
      }
      const auto added = std::count_if(shown.begin(), shown.end(), [](const auto& one) { return one.completes; });
      if (added > 0) {
        line(fmt::format("  {} for people who only just miss what those leave open",
                         counted(static_cast<std::size_t>(added), "demonstration")));
      }
    }
  }

  [[nodiscard]] std::string start_text(StartId id) const {
    auto text = fmt::format("{}, start {}", world_text(domain_, id.mdp), id.start.value());
    const auto map = domain_.drawing();
    if (!map) return text + ": " + domain_.state_name(id.mdp, id.start);
    const auto state = map->state(id.mdp, id.start);
    const auto items = map->items_in(id.mdp);
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (state.carried[i]) {
        text += ", carrying " + map->item_names()[items[i]];
      } else if (state.items[i] == state.robot) {
        text += ", on the same cell as " + map->item_names()[items[i]];
      }
    }
    return text;
  }

  // " (likeliest path, chance 12 %)" where chance has a part.
  [[nodiscard]] std::string chance(StartId id, const Trajectory& path) const {
    const auto words = chance_in_words(domain_, id.mdp, path);
    return words.empty() ? "" : " (" + words + ")";
  }

  // @param is_for_everybody  whether the lesson was chosen as a whole, by what all members are expected to make of it.
  void demonstration(std::size_t number, const Demonstration& shown, bool is_for_everybody) {
    const auto id = atlas_.id(shown.start);
    const auto path = atlas_.trajectory(shown.start);
    const auto& counts = atlas_.feature_counts(shown.start);
    line();
    line(fmt::format("  Demonstration {}: {}", number, start_text(id)));
    out_ += start_and_path(domain_, id, path, 4);
    line("    " + actions_text(domain_, id.mdp, path) + chance(id, path));
    line(fmt::format("    {}; return {:.4f}", counts_text(domain_, counts), return_of(domain_, counts)));
    line("    conveys:");
    for (const auto& half_space : shown.half_spaces) line("      " + described(domain_, half_space));
    const auto* others = shown.half_spaces.size() > shown.num_new ? " (the others are implied or known)" : "";
    if (is_for_everybody) {
      line(fmt::format("    new constraints: {}{}", shown.num_new, others));
      line(fmt::format("    narrows what people may believe {:.3g}-fold", shown.gain));
    } else {
      line(fmt::format("    chosen because it adds the fewest new constraints: {}{}", shown.num_new, others));
      line(fmt::format("    and among those, narrows what people may believe the most ({:.3g}-fold)", shown.gain));
    }
  }

  void taught(const Lesson& lesson) {
    line();
    line("  The lesson as a whole:");
    for (const auto& half_space : lesson.taught) line("    " + described(domain_, half_space));
    line(fmt::format("    area {:.4f} sr; with components learned before {:.4f} sr; log gain {:.4f}", lesson.area_sr,
                     lesson.running_area_sr, lesson.gain));
    if (lesson.untested > 0) line(fmt::format("    constraints that cannot be tested: {}", lesson.untested));
    if (lesson.tests_demonstrated > 0) {
      line(fmt::format("    tests that were demonstrated, since nothing else is left: {}", lesson.tests_demonstrated));
    }
  }

  void test(const TranscriptPeriod& period, std::size_t t) {
    const auto& asked = period.lesson.tests[t];
    const auto id = atlas_.id(asked.start);
    const auto path = atlas_.trajectory(asked.start);
    line();
    line(fmt::format("  Test {}: {}; what would the robot do?", t + 1, start_text(id)));
    out_ += start_and_path(domain_, id, path, 4);
    line("    the robot: " + actions_text(domain_, id.mdp, path) + chance(id, path) + " (" +
         counts_text(domain_, atlas_.feature_counts(asked.start)) + ")");
    for (const auto& half_space : asked.covered) {
      line("    tests " + described(domain_, half_space) + (asked.exact ? "" : " (the closest possible test)"));
    }
    for (std::size_t i = 0; i < members_.size(); ++i) answer(period, t, i);
    for (std::size_t i = 0; i < members_.size(); ++i) revised_answer(period, t, i);
  }

  // What the member says after the discussion, if it is something else.
  void revised_answer(const TranscriptPeriod& period, std::size_t t, std::size_t i) {
    if (i >= period.revised.size() || period.revised[i].empty()) return;
    const auto& answer = period.revised[i][t];
    if (!answer || answer == period.responses[i].answers[t]) return;
    const auto& verdict = period.feedback.revised[i][t];
    line(fmt::format("    member {} changes it after the discussion: {}: {}", members_[i], judged(verdict),
                     counts_text(domain_, *answer)));
  }

  [[nodiscard]] std::string judged(const Verdict& verdict) const {
    if (verdict.correct) return "correct";
    return fmt::format("wrong (regret {:.4g})", in_file_units(domain_.weights(), verdict.regret));
  }

  void answer(const TranscriptPeriod& period, std::size_t t, std::size_t i) {
    if (period.feedback.verdicts[i].empty()) return;  // was not there
    const auto& verdict = period.feedback.verdicts[i][t];
    const auto& response = period.responses[i];
    if (t >= response.answers.size() || !response.answers[t]) {
      line(fmt::format("    member {}: no answer", members_[i]));
      return;
    }
    const auto& counts = *response.answers[t];
    const auto start = period.lesson.tests[t].start;
    const auto path = response.weights ? path_of_answer(atlas_, start, counts, *response.weights) : std::nullopt;
    const auto described_path =
        path ? actions_text(domain_, atlas_.id(start).mdp, *path) + " (" + counts_text(domain_, counts) + ")"
             : counts_text(domain_, counts);
    line(fmt::format("    member {}: {}: {}", members_[i], judged(verdict), described_path));
    const std::string shows = verdict.correct ? "evidence that they know " : "evidence that they believe ";
    for (const auto& half_space : verdict.half_spaces) line("      " + shows + described(domain_, half_space));
  }

  void beliefs(const TranscriptPeriod& period) {
    line();
    line("  Beliefs: probability of the policy's class and of the lesson's region, effective sample size");
    line(fmt::format("    {:<22} {:>17} {:>17} {:>15}", "", "class", "lesson", "sample size"));
    for (std::size_t i = 0; i < period.before.own.size(); ++i)
      belief_row("own, ", period.before.own[i], period.after.own[i]);
    for (std::size_t i = 0; i < period.before.teacher.size(); ++i) {
      belief_row("teacher's, ", period.before.teacher[i], period.after.teacher[i]);
    }
  }

  void belief_row(const std::string& kind, const BeliefFigures& before, const BeliefFigures& after) {
    line(fmt::format("    {:<22} {:>7.4f} -> {:.4f}  {:>7.4f} -> {:.4f}", kind + before.whose, before.p_bec,
                     after.p_bec, before.p_taught, after.p_taught));
    if (before.ess && after.ess)
      out_.insert(out_.size() - 1, fmt::format(" {:>6.0f} -> {:<6.0f}", *before.ess, *after.ess));
    out_.erase(out_.find_last_not_of(" \n") + 1);
    line();
  }

  // A new component resets every ability: it has not fallen by itself.
  void conclusion(const TranscriptPeriod& period, bool begins) {
    line();
    for (std::size_t i = 0; i < members_.size(); ++i) {
      const auto& before = period.before.abilities[i];
      const auto& after = period.after.abilities[i];
      if (is_away(period, i)) {
        line(fmt::format("  Member {}: released from this component", members_[i]));
        continue;
      }
      const auto* verdict = period.feedback.all_correct[i] ? "all answers correct" : "corrected";
      line(before && after ? fmt::format("  Member {}: ability {:.4f}{} -> {:.4f} ({})", members_[i], *before,
                                         begins ? ", reset for this component" : "", *after, verdict)
                           : fmt::format("  Member {}: {}", members_[i], verdict));
    }
    for (const auto member : period.feedback.excluded) {
      line(fmt::format("  Member {} is left out of the common belief in this period: the answers conflict",
                       members_[member]));
    }
    for (const auto member : period.feedback.released) {
      line(fmt::format("  Member {} is done with this component and returns with the next one", members_[member]));
    }
    const bool all = std::all_of(period.feedback.all_correct.begin(), period.feedback.all_correct.end(),
                                 [](bool right) { return right; });
    const auto& name = atlas_.knowledge_components()[period.lesson.component].name;
    if (period.feedback.component_learned) {
      line("  Learned: " + name + (all ? " (all members answered all tests correctly)" : ""));
    } else {
      line("  " + name + " is not learned yet" +
           (all ? ": more periods in a row with all answers correct are required" : ""));
    }
    if (period.forecast) {
      const auto& ahead = *period.forecast;
      line(
          fmt::format("  Forecast: {:.1f} more periods; everything is learned after one more with probability {:.2f}, "
                      "after two {:.2f}, after three {:.2f}",
                      ahead.periods_left, ahead.done_within[0], ahead.done_within[1], ahead.done_within[2]));
    }
  }

  [[nodiscard]] static bool is_away(const TranscriptPeriod& period, std::size_t i) {
    return !period.lesson.tests.empty() && period.feedback.verdicts[i].empty();
  }

  // Before the first lesson.
  void forecast() {
    const auto all = forecast_remaining(transcript_.imagined, {});
    const auto ahead = forecast_of(all);
    line();
    line(fmt::format("Forecast from {} imagined teams of the same kind (in brackets the central 80 %):",
                     transcript_.imagined.size()));
    line(fmt::format("  {:.1f} periods ({:.0f} to {:.0f}), {:.0f} minutes ({:.0f} to {:.0f}) by the study's pace",
                     ahead.periods, ahead.periods_low, ahead.periods_high, ahead.minutes, ahead.minutes_low,
                     ahead.minutes_high));
    const auto first = static_cast<std::size_t>(ahead.periods_low), last = static_cast<std::size_t>(ahead.periods_high);
    std::string done;
    for (auto k = first; k <= last; ++k)
      done += fmt::format("{}{} periods {:.2f}", done.empty() ? "" : ", ", k, all.done_within(k));
    line("  probability that everything is learned after " + done);
  }

  void ending() {
    const auto& record = transcript_.record;
    line();
    line(std::string(kTextWidth, '='));
    const auto shown = counted(record.demonstrations, "demonstration") + " and " + counted(record.tests, "test");
    if (transcript_.sessions.size() == 1) {
      line(summary(transcript_.sessions.front()) + ", with " + shown);
    } else {
      line("In all sessions " + counted(record.periods, "period") + ", " + shown);
    }
    for (const auto& learner : record.learners) {
      line(fmt::format("  member {}: final belief in the policy's class {:.4f}, {} of {} answers correct",
                       learner.member, learner.p_bec, learner.correct, learner.tests));
    }
    if (record.learners.size() > 1) line(fmt::format("  mean of the members: {:.4f}", record.knowledge));
  }

  const Atlas& atlas_;
  const Domain& domain_;
  const Transcript& transcript_;
  std::vector<std::size_t> members_;
  std::string out_;
};

}  // namespace

std::string to_text(const Atlas& atlas, const Transcript& transcript) {
  return TranscriptWriter{atlas, transcript}.text();
}

}  // namespace kith
