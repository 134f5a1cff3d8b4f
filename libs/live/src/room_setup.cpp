#include <nlohmann/json.hpp>

#include "kith/core/error.hpp"
#include "kith/live/room.hpp"

namespace kith {

Json to_json(const RoomSetup& setup) {
  Json simulated = Json::array();
  for (const bool is_simulated : setup.simulated) simulated.push_back(is_simulated);
  return {{"id", setup.id},
          {"code", setup.code},
          {"strategy", setup.strategy},
          {"composition", setup.composition},
          {"simulated", simulated},
          {"replicate", setup.replicate},
          {"salt", setup.salt}};
}

RoomSetup room_setup(const Json& json) {
  try {
    RoomSetup setup;
    setup.id = json.at("id").get<std::string>();
    setup.code = json.at("code").get<std::string>();
    setup.strategy = json.at("strategy").get<std::string>();
    setup.composition = json.at("composition").get<std::string>();
    for (const auto& is_simulated : json.at("simulated")) setup.simulated.push_back(is_simulated.get<bool>());
    setup.replicate = json.at("replicate").get<std::size_t>();
    setup.salt = json.at("salt").get<std::string>();
    return setup;
  } catch (const Json::exception& error) {
    throw Error{ErrorKind::kInvalidInput, std::string{"this is not the set-up of a room: "} + error.what()};
  }
}

}  // namespace kith
