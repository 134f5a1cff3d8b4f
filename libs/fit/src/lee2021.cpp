#include "kith/fit/lee2021.hpp"

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "kith/core/error.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/table/table_text.hpp"
#include "open_table.hpp"

namespace kith {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxStates = 20'000;  // the study's worlds have hundreds

// What is wrong with a record.
struct BadRecord : std::runtime_error {
  using std::runtime_error::runtime_error;
};

const Json& field(const Json& record, const std::string& name) {
  if (!record.is_object()) throw BadRecord{"'" + name + "' is looked for in something that is no object"};
  const auto it = record.find(name);
  if (it == record.end()) throw BadRecord{"'" + name + "' is missing"};
  return *it;
}

int integer(const Json& record, const std::string& name) {
  const auto& value = field(record, name);
  if (!value.is_number_integer()) throw BadRecord{"'" + name + "' must be an integer"};
  if (std::abs(value.get<double>()) > 1e9) throw BadRecord{"'" + name + "' is too large"};
  return value.get<int>();
}

std::string text(const Json& record, const std::string& name) {
  const auto& value = field(record, name);
  if (!value.is_string()) throw BadRecord{"'" + name + "' must be text"};
  return value.get<std::string>();
}

const Json& list(const Json& record, const std::string& name) {
  const auto& value = field(record, name);
  if (!value.is_array()) throw BadRecord{"'" + name + "' must be a list"};
  return value;
}

const Json& only(const Json& record, const std::string& name) {
  const auto& value = list(record, name);
  if (value.size() != 1) throw BadRecord{"'" + name + "' must have one element"};
  return value.front();
}

// A map that is drawn cell by cell, and written down with one symbol for every different cell.
class MapText {
 public:
  MapText(int width, int height) : width_{width}, height_{height} {
    constexpr int kMaxSide = 100;
    if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide) {
      throw BadRecord{"a map of " + std::to_string(width) + " x " + std::to_string(height) + " cells"};
    }
  }

  // `entry` is one entry of a table of the legend: "wall = true".
  void put(int x, int y, const std::string& entry) {
    if (x < 1 || x > width_ || y < 1 || y > height_) {
      throw BadRecord{"the cell (" + std::to_string(x) + ", " + std::to_string(y) + ") is off the map"};
    }
    cells_[{x, y}].insert(entry);
  }
  void put(const Json& place, const std::string& entry) { put(integer(place, "x"), integer(place, "y"), entry); }

  [[nodiscard]] std::string toml() const {
    std::map<std::string, char> symbols{{"\"floor\"", '.'}};
    std::string rows;
    for (int y = height_; y >= 1; --y) {
      rows += rows.empty() ? "\"" : ", \"";
      for (int x = 1; x <= width_; ++x) {
        const auto meaning = meaning_of(x, y);
        const auto next = static_cast<char>('a' + static_cast<char>(symbols.size() - 1));
        rows += symbols.try_emplace(meaning, next).first->second;
      }
      rows += '"';
    }
    std::string result = "[map]\nrows = [" + rows + "]\n[map.legend]\n";
    for (const auto& [meaning, symbol] : symbols) result += std::string{'"'} + symbol + "\" = " + meaning + "\n";
    return result;
  }

 private:
  [[nodiscard]] std::string meaning_of(int x, int y) const {
    const auto it = cells_.find({x, y});
    if (it == cells_.end()) return "\"floor\"";
    std::string entries;
    for (const auto& entry : it->second) entries += (entries.empty() ? "" : ", ") + entry;
    return "{ " + entries + " }";
  }

  int width_;
  int height_;
  std::map<std::pair<int, int>, std::set<std::string>> cells_;
};

std::string head_of(const std::string& id, const std::string& actions) {
  std::string name = id;
  for (char& c : name) c = c == '_' ? '-' : c;
  return "schema = \"kith.domain/1\"\nid = \"" + name + "\"\n[mdp]\nactions = [" + actions + "]\n";
}

std::string feature(const std::string& name, const std::string& when, const std::string& exclusive = "") {
  return "[[feature]]\nname = \"" + name + "\"\nwhen = \"" + when + "\"\n" +
         (exclusive.empty() ? "" : "exclusive = \"" + exclusive + "\"\n");
}

constexpr const char* kMoves = R"("up", "down", "left", "right", "exit")";
constexpr const char* kMovesAndHands = R"("up", "down", "left", "right", "pickup", "dropoff", "exit")";
constexpr const char* kPrior = "normalize = \"l1\"\n[prior]\nhalfspaces = [ { step = -1 } ]\n";

MapText map_with_walls(const Json& world) {
  MapText map{integer(world, "width"), integer(world, "height")};
  for (const auto& wall : list(world, "walls")) map.put(wall, "wall = true");
  map.put(field(world, "agent"), "start = true");
  return map;
}

void must_be_zero(const Json& record, const std::string& name) {
  if (integer(record, name) != 0) throw BadRecord{"'" + name + "' must be 0: nobody starts with something in hand"};
}

void must_be_empty(const Json& world, const std::string& name) {
  if (world.contains(name) && !list(world, name).empty()) throw BadRecord{"'" + name + "' must be empty"};
}

std::string taxi_text(const std::string& id, const Json& world) {
  auto map = map_with_walls(world);
  must_be_zero(field(world, "agent"), "has_passenger");
  must_be_empty(world, "traffic");
  must_be_empty(world, "fuel_station");
  for (const auto& toll : list(world, "tolls")) map.put(toll, "terrain = \"toll\"");
  const auto& passenger = only(world, "passengers");
  map.put(passenger, "item = \"passenger\"");
  map.put(integer(passenger, "dest_x"), integer(passenger, "dest_y"), "destination = \"passenger\"");
  return head_of(id, kMovesAndHands) + map.toml() + feature("delivery", "deliver:passenger") +
         feature("toll", world.at("tolls").empty() ? "action & !action" : "enter:toll") + feature("step", "action") +
         "[reward]\nweights = { delivery = 26, toll = -3, step = -1 }\n" + kPrior;
}

std::string two_goal_text(const std::string& id, const Json& world) {
  auto map = map_with_walls(world);
  const auto& goals = list(world, "goals");
  if (goals.size() != 2) throw BadRecord{"'goals' must have two elements"};
  map.put(goals[0], "goal = \"first\"");
  map.put(goals[1], "goal = \"second\"");
  return head_of(id, kMoves) + map.toml() + feature("first", "goal:first") + feature("second", "goal:second") +
         feature("step", "action") + "[reward]\nweights = { first = 7.25, second = 10.5, step = -1 }\n" + kPrior;
}

std::string skateboard_text(const std::string& id, const Json& world) {
  auto map = map_with_walls(world);
  must_be_zero(field(world, "agent"), "has_skateboard");
  map.put(only(world, "skateboard"), "item = \"skateboard\"");
  map.put(field(world, "goal"), "goal = true");
  return head_of(id, kMovesAndHands) + map.toml() + feature("goal", "goal") +
         feature("board",
                 "carrying:skateboard & (action:up | action:down | action:left | action:right) | action:pickup | "
                 "action:dropoff",
                 "move") +
         feature("step", "action", "move") + "[reward]\nweights = { goal = 9, board = -0.3, step = -1 }\n" + kPrior;
}

std::string domain_text_of(const std::string& id, const std::string& family, const Json& world) {
  if (family == "augmented_taxi") return taxi_text(id, world);
  if (family == "two_goal") return two_goal_text(id, world);
  if (family == "skateboard") return skateboard_text(id, world);
  throw BadRecord{"'domain' is '" + family + "', which is none of augmented_taxi, two_goal, skateboard"};
}

// The world of one line, or nothing after adding what is wrong.
std::optional<RecordedWorld> world_of(const std::string& line, const std::filesystem::path& path, std::size_t number,
                                      std::vector<Diagnostic>& diagnostics) {
  const auto record = Json::parse(line, nullptr, false);
  if (record.is_discarded() || !record.is_object()) {
    diagnostics.push_back(detail::fault("E0701", "this line is no JSON object", path, number));
    return std::nullopt;
  }
  try {
    const auto id = text(record, "mdp_id");
    const auto family = text(record, "domain");
    const auto& world = field(record, "mdp");
    const auto domain_text = domain_text_of(id, family, world);
    std::vector<std::string> actions;
    for (const auto& action : list(world, "opt_actions")) actions.push_back(action.get<std::string>());
    auto reading = parse_domain(domain_text, path.string() + " (" + id + ")", {.max_states = kMaxStates});
    if (!reading.domain) {
      diagnostics.insert(diagnostics.end(), reading.diagnostics.begin(), reading.diagnostics.end());
      return std::nullopt;
    }
    return RecordedWorld{id,
                         family,
                         text(world, "test_difficulty"),
                         actions,
                         field(world, "opt_traj_reward").get<double>(),
                         domain_text,
                         *std::move(reading.domain)};
  } catch (const BadRecord& error) {
    diagnostics.push_back(detail::fault("E0702", std::string{"not a test world: "} + error.what(), path, number));
  } catch (const Json::exception& error) {
    diagnostics.push_back(detail::fault("E0702", std::string{"not a test world: "} + error.what(), path, number));
  }
  return std::nullopt;
}

}  // namespace

std::vector<RecordedWorld> read_lee2021_worlds(const std::filesystem::path& path) {
  std::istringstream lines{read_table_text(path)};
  std::vector<RecordedWorld> worlds;
  std::vector<Diagnostic> diagnostics;
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    if (auto world = world_of(line, path, number, diagnostics)) worlds.push_back(*std::move(world));
  }
  detail::throw_if_errors(diagnostics);
  return worlds;
}

std::vector<RecordedResponse> read_lee2021_responses(const std::filesystem::path& path) {
  const auto column = [](std::string name, ColumnType type) {
    return Column{.name = std::move(name), .type = type, .required = true};
  };
  std::vector<RecordedResponse> responses;
  std::vector<Diagnostic> diagnostics;
  detail::read_open_csv(
      path,
      {column("participant", ColumnType::kInteger), column("domain", ColumnType::kText),
       column("mdp_id", ColumnType::kText), column("test_difficulty", ColumnType::kInteger),
       column("optimal_response", ColumnType::kInteger), column("moves", ColumnType::kText)},
      {{.name = "experiment", .type = ColumnType::kInteger}}, diagnostics, [&](const detail::OpenRow& row) {
        const auto count = [&](const char* name) { return static_cast<std::size_t>(row.integer(name).value_or(1)); };
        responses.push_back({count("participant"), count("experiment"), *row.text("domain"), *row.text("mdp_id"),
                             count("test_difficulty"), count("optimal_response") != 0,
                             detail::words_of(*row.text("moves")), row.line()});
      });
  detail::throw_if_errors(diagnostics);
  return responses;
}

}  // namespace kith
