#include "bot_mind.hpp"

#include <cstdint>
#include <utility>

#include "kith/live/room_phase.hpp"

namespace kith {
namespace {

// Something of the right kind for every question.
Json answers_to(const Json& items) {
  auto answers = Json::object();
  for (const auto& item : items) {
    const auto kind = item.value("kind", "");
    auto& answer = answers[item.value("id", "")];
    if (kind == "likert") {
      answer = 3;
    } else if (kind == "choice" && item.contains("options") && !item["options"].empty()) {
      answer = item["options"][0];
    } else {
      answer = "rehearsal";
    }
  }
  return answers;
}

// A member that is a whole number, or what to take without one: get<int>() converts any number, which is undefined for
// large ones.
int int_at(const Json& object, const char* name, int otherwise) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_number_integer()) return otherwise;
  const bool fits = found->is_number_unsigned() ? std::in_range<int>(found->get<std::uint64_t>())
                                                : std::in_range<int>(found->get<std::int64_t>());
  return fits ? found->get<int>() : otherwise;
}

std::string number(const Json& object, const char* name) {
  return object.contains(name) ? object[name].dump() : std::string{};
}

// Which period this is, as far as a participant is told.
std::string period_of(const Json& view) {
  if (!view.contains("progress")) return {};
  return number(view["progress"], "part") + "." + number(view["progress"], "round");
}

BotAct path_for(const Json& task, const std::string& type, const std::string& period) {
  return {.type = type,
          .body = {{"test", int_at(task, "index", 0)}},
          .key = type + period + "/" + number(task, "index"),
          .pace = 1.0,
          .world = task.value("world", ""),
          .start = int_at(task, "start", -1)};
}

// Takes the prediction that most of the group made, and keeps the own one if that is not clear.
BotAct decision_on(const Json& shown, const std::string& stage) {
  const auto& predictions = shown.at("predictions");
  int most = 0;
  bool is_tied = false;
  Json choice;
  for (std::size_t i = 0; i < predictions.size(); ++i) {
    const auto n = int_at(predictions[i], "n", 0);
    if (n < most) continue;
    is_tied = n == most;
    if (is_tied) continue;
    most = n;
    choice = predictions[i].value("own", false) ? Json{} : Json(i);
  }
  return {.type = "discuss",
          .body = {{"test", int_at(shown, "index", 0)}, {"choice", is_tied ? Json{} : choice}, {"ms", 0}},
          .key = stage + "/" + number(shown, "index"),
          .pace = 0.5};
}

}  // namespace

bool is_last_stage(const std::string& stage) {
  return stage == "debrief" || stage == "ended" || stage == "declined" || stage == "full" || stage == "replaced";
}

std::optional<BotAct> act_for(const Json& view) try {
  if (view.contains("pause")) return std::nullopt;
  const auto stage = view.value("stage", "");
  const auto period = period_of(view);
  if (stage == "consent") {
    const Json body{{"accept", true}, {"version", view.at("consent").at("version")}};
    return BotAct{.type = "consent", .body = body, .key = stage, .pace = 0.2};
  }
  if (stage == "check") return BotAct{.type = "checked", .body = Json::object(), .key = stage, .pace = 0.2};
  if (stage == "screening") return path_for(view.at("predict"), "screen", period);
  if (stage == kExamPage) return path_for(view.at("predict"), "examine", period);
  const auto phase = phase_of_page(stage);
  if (!phase) return std::nullopt;
  switch (*phase) {
    case RoomPhase::kWatching:
      return BotAct{.type = "watched",
                    .body = {{"demo", int_at(view.at("watch"), "index", 0)}},
                    .key = stage + period + "/" + number(view["watch"], "index"),
                    .pace = 0.5};
    case RoomPhase::kTesting:
      return path_for(view.at("predict"), "answer", period);
    case RoomPhase::kDiscussing:
      return decision_on(view.at("discuss"), stage + period);
    case RoomPhase::kFeedback:
      return BotAct{.type = "continue", .body = Json::object(), .key = stage + period, .pace = 0.3};
    case RoomPhase::kQuestions: {
      const Json body{{"answers", answers_to(view.at("questions").at("items"))}};
      return BotAct{.type = "questions", .body = body, .key = stage, .pace = 0.5};
    }
    case RoomPhase::kLobby:
    case RoomPhase::kTeaching:
    case RoomPhase::kEnded:
      return std::nullopt;
  }
  return std::nullopt;
} catch (const Json::exception&) {
  return std::nullopt;
}

}  // namespace kith
