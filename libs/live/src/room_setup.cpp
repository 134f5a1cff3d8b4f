#include <nlohmann/json.hpp>

#include "kith/core/error.hpp"
#include "kith/live/room.hpp"

namespace kith {

Json to_json(const RoomSetup& setup) {
  Json json{{"id", setup.id},
            {"code", setup.code},
            {"strategy", setup.strategy},
            {"composition", setup.composition},
            {"simulated", setup.simulated},
            {"replicate", setup.replicate},
            {"salt", setup.salt}};
  if (setup.is_waiting_list) json["waiting_list"] = true;
  if (setup.lessons > 0) json["lessons"] = setup.lessons;
  return json;
}

RoomSetup room_setup(const Json& json) {
  try {
    RoomSetup setup;
    setup.id = json.at("id").get<std::string>();
    setup.code = json.at("code").get<std::string>();
    setup.strategy = json.at("strategy").get<std::string>();
    setup.composition = json.at("composition").get<std::string>();
    setup.simulated = json.at("simulated").get<std::vector<bool>>();
    setup.replicate = json.at("replicate").get<std::size_t>();
    setup.salt = json.at("salt").get<std::string>();
    setup.is_waiting_list = json.value("waiting_list", false);
    setup.lessons = json.value("lessons", json.value("avoids_repeats", false) ? std::size_t{1} : std::size_t{0});
    return setup;
  } catch (const Json::exception& error) {
    throw Error{ErrorKind::kInvalidInput, std::string{"this is not the set-up of a room: "} + error.what()};
  }
}

}  // namespace kith
