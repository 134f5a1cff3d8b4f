#include "kith/live/lesson_log.hpp"

#include "kith/core/error.hpp"
#include "kith/files/sha256.hpp"

namespace kith {

Json to_json(const RoomEvent& event) {
  return {{"seq", event.seq},
          {"at_us", event.at_us},
          {"actor", event.actor},
          {"type", event.kind().word},
          {"body", body_of(event)}};
}

RoomEvent room_event(const Json& json) try {
  return room_event(json.at("seq").get<std::uint64_t>(), json.at("at_us").get<std::int64_t>(),
                    json.at("actor").get<std::string>(), json.at("type").get<std::string>(), json.at("body"));
} catch (const Json::exception& error) {
  throw Error{ErrorKind::kInvalidInput, std::string{"this is no event of a room: "} + error.what()};
}

Json lesson_content(const TaughtLesson& lesson, std::uint64_t seq) {
  Json demos = Json::array(), tests = Json::array();
  if (lesson.after->phase() != SessionPhase::kFinished) {
    for (const auto& shown : lesson.after->lesson().demonstrations) demos.push_back(shown.start.value());
    for (const auto& test : lesson.after->lesson().tests) tests.push_back(test.start.value());
  }
  return {{"seq", seq}, {"demos", demos}, {"tests", tests}};
}

std::string sealed(const std::string& before, const RoomEvent& last) { return sha256(before + to_json(last).dump()); }

}  // namespace kith
