// Pictures of explicit models: which variables of states place the robot and other things on a map.
#include "model_drawing.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <numeric>
#include <string_view>

#include "explicit_family.hpp"
#include "kith/domains/model_formats.hpp"

namespace kith {
namespace detail {
namespace {

constexpr std::size_t kMostColumns = 1000;

class DrawingReader {
 public:
  DrawingReader(RawModel& model, TomlReport& report, ModelReport& model_report, DrawingPlan& plan)
      : model_{model}, report_{report}, model_report_{model_report}, plan_{plan} {}

  void read(TomlReader& drawing) {
    plan_.place = drawing.place();
    if (drawing.has("columns")) {
      plan_.robot = numbered_cells();
    } else {
      read_thing(drawing, plan_.robot);
      read_origin(drawing);
    }
    plan_.has_walls = drawing.boolean("walls", Presence::kOptional).value_or(true);
    if (auto things = drawing.table("things", Presence::kOptional)) {
      for (const TomlEntry& entry : things->content().entries()) read_placed(entry);
    }
    drawing.finish();
    check_movable();
    check_groups();
  }

  // Every state, also those that are left out later: a file is easier to mend while all of it is wrong.
  void check_states() {
    for (const RawMdp& mdp : model_.mdps) {
      for (std::size_t s = 0; s < mdp.states.size(); ++s) {
        const std::int32_t* values = mdp.variables.data() + s * model_.variables.size();
        check_state(mdp.states[s], "the robot", plan_.robot, values);
        for (std::size_t i = 0; i < plan_.things.size(); ++i) {
          if (is_carried(plan_.things[i], values)) continue;
          check_state(mdp.states[s], plan_.names[i], plan_.things[i], values);
        }
        if (model_report_.is_full()) return;
      }
    }
  }

 private:
  static bool is_carried(const DrawnThing& thing, const std::int32_t* values) {
    return thing.carried && values[*thing.carried] != 0;
  }

  std::size_t variable(TomlReader& table, const char* key) {
    const auto name = table.string(key, Presence::kRequired);
    if (!name) return 0;
    const auto at = std::ranges::find(model_.variables, *name);
    if (at != model_.variables.end()) return static_cast<std::size_t>(at - model_.variables.begin());
    report_.error("E0276", table.content().find(key)->place(), "states have no variable '" + *name + "'",
                  model_.variables.empty() ? "give each state integer variables for its column and its row"
                                           : suggestion(*name, model_.variables));
    return 0;
  }

  void read_thing(TomlReader& table, DrawnThing& thing) {
    thing.x = variable(table, "x");
    thing.y = variable(table, "y");
  }

  // The columns and rows that add_numbered_cells() gave the states.
  [[nodiscard]] DrawnThing numbered_cells() const {
    DrawnThing robot;
    robot.x = model_.variables.size() - 2;
    robot.y = model_.variables.size() - 1;
    return robot;
  }

  void read_origin(TomlReader& drawing) {
    const TomlArray* origin = drawing.array("origin", Presence::kOptional);
    if (origin == nullptr) return;
    if (origin->size() != 2) {
      report_.error("E0276", drawing.content().find("origin")->place(),
                    "'origin' is the x and the y of the top left cell", "for instance origin = [0, 0]");
      return;
    }
    for (std::size_t i = 0; i < 2; ++i) {
      const auto value = read_integer((*origin)[i], "every element of 'origin'", {-1'000'000, 1'000'000}, report_);
      plan_.origin[i] = value.value_or(1);
    }
  }

  // SYMBOL = { x = "VARIABLE", y = "VARIABLE", carried = "VARIABLE" }
  void read_placed(const TomlEntry& entry) {
    const TomlTable* table = read_table(entry.value, "'" + entry.key + "'", report_);
    if (table == nullptr) return;
    TomlReader reader{*table, entry.value.place(), "[model.drawing.things]", report_};
    DrawnThing thing;
    read_thing(reader, thing);
    if (reader.has("carried")) thing.carried = variable(reader, "carried");
    reader.finish();

    const auto& symbols = plan_.family_map.symbols;
    const auto at = std::ranges::find_if(
        symbols, [&](const Symbol& symbol) { return entry.key.size() == 1 && symbol.glyph == entry.key.front(); });
    if (at == symbols.end()) {
      report_.error("E0278", entry.place, "'" + entry.key + "' is not a symbol of [map.legend]",
                    "declare it there as { item = \"NAME\" } or { destination = \"NAME\" }");
      return;
    }
    if (!is_movable(*at)) {
      report_.error("E0278", entry.place, "symbol '" + entry.key + "' is neither an item nor a destination",
                    "only those are placed by variables; draw everything else in the rows of [map]");
      return;
    }

    plan_.things.push_back(thing);
    plan_.symbols.push_back(static_cast<std::uint8_t>(at - symbols.begin()));
    plan_.names.push_back(at->content.item.empty() ? "destination of " + at->content.destination : at->content.item);
  }

  static bool is_movable(const Symbol& symbol) {
    return !symbol.content.item.empty() || !symbol.content.destination.empty();
  }

  // Items are where the states say; destinations may be drawn in the rows instead.
  void check_movable() {
    const FamilyMap& family_map = plan_.family_map;
    for (std::size_t i = 0; i < family_map.symbols.size(); ++i) {
      const Symbol& symbol = family_map.symbols[i];
      if (!is_movable(symbol)) continue;
      const auto number = static_cast<std::uint8_t>(i);
      const bool is_placed = std::ranges::find(plan_.symbols, number) != plan_.symbols.end();
      const bool is_drawn =
          std::ranges::find(family_map.symbol_of, number) != family_map.symbol_of.end() ||
          std::ranges::any_of(family_map.painted, [&](const MapThing& thing) { return thing.symbol == number; });
      const std::string quoted = std::string{"symbol '"} + symbol.glyph + "'";
      if (is_drawn && (is_placed || !symbol.content.item.empty())) {
        report_.error("E0278", symbol.place, quoted + " is on the map, but states place it",
                      "draw what lies below it in the rows");
      } else if (!is_drawn && !is_placed) {
        report_.error("E0278", symbol.place, "nothing says where " + quoted + " is",
                      std::string{"add "} + symbol.glyph +
                          " = { x = \"VARIABLE\", y = \"VARIABLE\" } under "
                          "[model.drawing.things]");
      }
    }
  }

  // What is optional is there in the MDP of that name.
  void check_groups() {
    std::vector<std::string> names;
    for (const RawMdp& mdp : model_.mdps) {
      if (!mdp.name.empty()) names.push_back(mdp.name);
    }
    for (const CellGroup& group : plan_.family_map.groups) {
      if (std::ranges::find(names, group.name) != names.end()) continue;
      report_.error(
          "E0277", group.place,
          group.name.empty() ? "'optional' must name the MDP in which this is on the map"
                             : "there is no MDP '" + group.name + "' in which this could be on the map",
          names.empty() ? "the model has one MDP without a name: remove 'optional'" : suggestion(group.name, names));
    }
  }

  void check_state(const RawState& state, const std::string& what, const DrawnThing& thing,
                   const std::int32_t* values) {
    const FamilyMap& family_map = plan_.family_map;
    const std::int64_t column = values[thing.x] - plan_.origin[0];
    const std::int64_t row = values[thing.y] - plan_.origin[1];
    const std::string at = model_.variables[thing.x] + " = " + std::to_string(values[thing.x]) + ", " +
                           model_.variables[thing.y] + " = " + std::to_string(values[thing.y]);
    if (column < 0 || column >= family_map.width || row < 0 || row >= family_map.height) {
      model_report_.error(
          "E0279", state.place,
          "in state '" + state.key + "' " + what + " is off the map of " + std::to_string(family_map.width) + " x " +
              std::to_string(family_map.height) + " cells: " + at,
          plan_.origin == std::array<std::int64_t, 2>{1, 1}
              ? "columns and rows are counted from 1, from the top left; [model.drawing] origin = "
                "[0, 0] counts from 0"
              : "the top left cell is " + std::to_string(plan_.origin[0]) + ", " + std::to_string(plan_.origin[1]));
      return;
    }
    const auto cell = static_cast<std::size_t>(row * family_map.width + column);
    const Symbol& symbol = family_map.symbols[family_map.symbol_of[cell]];
    if (!symbol.content.wall || symbol.is_optional()) return;
    model_report_.error("E0279", state.place,
                        "in state '" + state.key + "' " + what + " is inside a wall of the map: " + at,
                        "draw another symbol at " + cell_text(family_map, cell) + ", or correct the state");
  }

  RawModel& model_;
  TomlReport& report_;
  ModelReport& model_report_;
  DrawingPlan& plan_;
};

// The number that a state is called by, as in "12" or "12 (end)"; nothing if it is called otherwise.
std::optional<std::uint32_t> number_of(const RawState& state) {
  const char* const begin = state.key.data();
  const char* const end = begin + state.key.size();
  std::uint32_t number = 0;
  const auto [stop, error] = std::from_chars(begin, end, number);
  const std::string_view rest{stop, static_cast<std::size_t>(end - stop)};
  if (error != std::errc{} || !(rest.empty() || rest == " (end)")) return std::nullopt;
  return number < kMaxModelStates ? std::optional{number} : std::nullopt;
}

// Gives states that are numbered row by row two more variables, their column and row from 1. The number of rows, or
// nothing after saying what is wrong.
std::optional<std::size_t> add_numbered_cells(RawModel& model, std::size_t columns, const TomlPlace& place,
                                              TomlReport& report) {
  std::size_t rows = 0;
  std::vector<std::vector<std::int32_t>> all;
  for (const RawMdp& mdp : model.mdps) {
    auto& variables = all.emplace_back();
    const auto width = model.variables.size();
    for (std::size_t s = 0; s < mdp.states.size(); ++s) {
      const auto number = number_of(mdp.states[s]);
      if (!number) {
        report.error("E0276", place, "'columns' needs states that are numbers, not '" + mdp.states[s].key + "'",
                     "place the robot by variables of the states: x = \"NAME\", y = \"NAME\"");
        return std::nullopt;
      }
      const auto first = mdp.variables.begin() + static_cast<std::ptrdiff_t>(s * width);
      variables.insert(variables.end(), first, first + static_cast<std::ptrdiff_t>(width));
      variables.push_back(static_cast<std::int32_t>(*number % columns) + 1);
      variables.push_back(static_cast<std::int32_t>(*number / columns) + 1);
      rows = std::max(rows, *number / columns + 1);
    }
  }
  if (rows > kMostColumns) {
    report.error("E0276", place, "'columns' makes a grid of " + std::to_string(rows) + " rows, more than 1000",
                 "say how many states there are in a row");
    return std::nullopt;
  }
  for (std::size_t m = 0; m < all.size(); ++m) model.mdps[m].variables = std::move(all[m]);
  model.variables.insert(model.variables.end(), {"column", "row"});
  return rows;
}

// A plain floor of numbered cells, where those in which every episode ends are marked.
FamilyMap plain_floor(const RawModel& model, std::size_t columns, std::size_t rows, const TomlPlace& place) {
  FamilyMap family_map;
  family_map.is_picture = family_map.legend_is_sound = family_map.is_sound = true;
  family_map.width = static_cast<int>(columns);
  family_map.height = static_cast<int>(rows);
  family_map.map_place = family_map.source_place = place;
  Symbol end;
  end.glyph = 'E';
  end.content.terrain = "end";
  family_map.symbols = {Symbol{}, end};
  family_map.terrain_names = {"end"};
  family_map.symbol_of.assign(columns * rows, 0);
  family_map.group_of.assign(columns * rows, -1);
  for (const RawState& state : model.mdps.front().states) {
    if (state.terminal) family_map.symbol_of[*number_of(state)] = 1;
  }
  return family_map;
}

// Draws the states of one MDP.
class MemberDrawer {
 public:
  MemberDrawer(const DrawingPlan& plan, std::size_t num_variables, const ExplicitMember& member)
      : plan_{plan}, num_variables_{num_variables}, member_{member}, look_size_{1 + 2 * plan.things.size()} {}

  DrawnMember draw() {
    const std::size_t num_states = member_.names.size();
    result_.looks.reserve(num_states * look_size_);
    for (std::size_t s = 0; s < num_states; ++s) add_look(s);
    result_.by_look.resize(num_states);
    std::iota(result_.by_look.begin(), result_.by_look.end(), 0U);
    std::stable_sort(result_.by_look.begin(), result_.by_look.end(), [this](std::uint32_t a, std::uint32_t b) {
      return std::lexicographical_compare(look(a), look(a) + look_size_, look(b), look(b) + look_size_);
    });
    if (plan_.has_walls) find_fences();
    return std::move(result_);
  }

 private:
  [[nodiscard]] const std::uint32_t* look(std::size_t s) const { return result_.looks.data() + s * look_size_; }

  void add_look(std::size_t s) {
    const std::int32_t* values = member_.variables.data() + s * num_variables_;
    const auto cell = [&](const DrawnThing& thing) {
      return static_cast<std::uint32_t>((values[thing.y] - plan_.origin[1]) * plan_.family_map.width + values[thing.x] -
                                        plan_.origin[0]);
    };
    const std::uint32_t robot = cell(plan_.robot);
    result_.looks.push_back(robot);
    for (const DrawnThing& thing : plan_.things) {
      const bool carried = thing.carried && values[*thing.carried] != 0;
      result_.looks.push_back(carried ? robot : cell(thing));
      result_.looks.push_back(carried ? 1 : 0);
    }
  }

  // Between neighbouring cells where the robot can be, of which neither leads to the other.
  void find_fences() {
    const auto width = static_cast<std::size_t>(plan_.family_map.width);
    const std::size_t num_cells = plan_.family_map.num_cells();
    std::vector<bool> is_met(num_cells, false);
    std::vector<bool> is_left(num_cells, false);  // the robot acts there
    std::vector<bool> to_right(num_cells, false);
    std::vector<bool> to_below(num_cells, false);
    const Mdp& mdp = member_.mdp;
    for (std::size_t s = 0; s < member_.names.size(); ++s) {
      is_met[*look(s)] = true;
      if (s >= mdp.num_states()) continue;
      is_left[*look(s)] = true;
      for (const Choice& choice : mdp.choices(StateIndex{s})) {
        for (const Outcome& outcome : mdp.outcomes(choice)) {
          const auto [first, second] = std::minmax({std::size_t{*look(s)}, std::size_t{*look(outcome.next.value())}});
          if (second == first + 1) to_right[first] = true;
          if (second == first + width) to_below[first] = true;
        }
      }
    }
    const auto add = [&](std::size_t a, std::size_t b, bool is_open) {
      if (is_open || !is_met[a] || !is_met[b] || !(is_left[a] || is_left[b])) return;
      result_.fences.emplace_back(plan_.family_map.cell_at(a), plan_.family_map.cell_at(b));
    };
    for (std::size_t cell = 0; cell < num_cells; ++cell) {
      if ((cell + 1) % width != 0) add(cell, cell + 1, to_right[cell]);
      if (cell + width < num_cells) add(cell, cell + width, to_below[cell]);
    }
  }

  const DrawingPlan& plan_;
  std::size_t num_variables_;
  const ExplicitMember& member_;
  std::size_t look_size_;
  DrawnMember result_;
};

// Whether the same actions have the same effects, as far as they can be seen.
bool act_alike(const Mdp& mdp, const DrawnMember& member, std::size_t look_size, StateIndex a, StateIndex b) {
  if (mdp.is_terminal(a) != mdp.is_terminal(b)) return false;
  if (mdp.is_terminal(a)) return true;
  const auto look = [&](StateIndex s) { return member.looks.data() + s.value() * look_size; };
  // What seems to change nothing is nothing to choose.
  const auto visible = [&](StateIndex s) {
    std::vector<Choice> choices;
    std::ranges::copy_if(mdp.choices(s), std::back_inserter(choices), [&](const Choice& choice) {
      return !std::ranges::all_of(mdp.outcomes(choice), [&](const Outcome& outcome) {
        return std::equal(look(s), look(s) + look_size, look(outcome.next));
      });
    });
    return choices;
  };
  return std::ranges::equal(visible(a), visible(b), [&](const Choice& x, const Choice& y) {
    return x.action == y.action &&
           std::ranges::equal(mdp.outcomes(x), mdp.outcomes(y), [&](const Outcome& one, const Outcome& other) {
             return one.probability == other.probability &&
                    std::ranges::equal(mdp.features(one), mdp.features(other)) &&
                    std::equal(look(one.next), look(one.next) + look_size, look(other.next));
           });
  });
}

// Two states that look the same, although what happens in them differs, if any.
std::optional<std::pair<StateIndex, StateIndex>> find_twins(const Mdp& mdp, const DrawnMember& member,
                                                            std::size_t look_size) {
  for (std::size_t i = 1; i < member.by_look.size(); ++i) {
    const StateIndex a{member.by_look[i - 1]};
    const StateIndex b{member.by_look[i]};
    const auto* look_a = member.looks.data() + a.value() * look_size;
    const auto* look_b = member.looks.data() + b.value() * look_size;
    if (!std::equal(look_a, look_a + look_size, look_b)) continue;
    if (!act_alike(mdp, member, look_size, a, b)) return std::pair{a, b};
  }
  return std::nullopt;
}

}  // namespace

DrawingPlan read_drawing(TomlReader& file, TomlReader& drawing, RawModel& model, NamedFiles& files,
                         ModelReport& model_report) {
  DrawingPlan plan;
  TomlReport& report = file.report();
  const auto know_all = [&] {
    for (const TomlEntry& entry : drawing.content().entries()) drawing.know(entry.key);
  };
  std::optional<std::size_t> rows;
  const auto columns = drawing.integer("columns", Presence::kOptional, {1, kMostColumns});
  if (columns) {
    rows = add_numbered_cells(model, static_cast<std::size_t>(*columns), drawing.content().find("columns")->place(),
                              report);
  }
  if (!file.has("map") && rows) {
    plan.family_map = plain_floor(model, static_cast<std::size_t>(*columns), *rows, drawing.place());
  } else if (!file.has("map")) {
    if (!drawing.has("columns")) {
      report.error(
          "E0275", drawing.place(), "[model.drawing] places the robot on a map, but there is no [map]",
          "draw one: [map] with rows and [map.legend]; or, if states are numbered row by row, give columns = N");
    }
    know_all();
    return plan;
  } else {
    plan.family_map = read_picture(file, files, model_report);
  }
  if (!plan.family_map.is_sound || (drawing.has("columns") && !rows)) {
    know_all();
    return plan;
  }
  DrawingReader reader{model, report, model_report, plan};
  reader.read(drawing);
  if (!report.has_errors() && !model_report.has_errors()) reader.check_states();
  return plan;
}

ModelDrawing draw_model(DrawingPlan&& plan, const ExplicitFamily& family, TomlReport& report) {
  ModelDrawing drawing;
  drawing.things = plan.names;
  drawing.symbol_of_thing = plan.symbols;

  for (const ExplicitMember& member : family.members) {
    std::uint64_t mask = 0;
    for (std::size_t group = 0; group < plan.family_map.groups.size(); ++group) {
      if (plan.family_map.groups[group].name == member.name) mask |= plan.family_map.bit_of(group);
    }
    plan.family_map.masks.push_back(mask);
    drawing.members.push_back(MemberDrawer{plan, family.variables.size(), member}.draw());
  }

  for (std::size_t m = 0; m < drawing.members.size(); ++m) {
    const auto twins = find_twins(family.members[m].mdp, drawing.members[m], drawing.look_size());
    if (!twins) continue;
    const auto& names = family.members[m].names;
    report.warning("W0207", plan.place,
                   "the drawing shows no difference between the states '" + names[twins->first.value()] + "' and '" +
                       names[twins->second.value()] + "'",
                   "place what differs under [model.drawing.things], if people have to know it");
    break;
  }
  drawing.family_map = std::move(plan.family_map);
  return drawing;
}

}  // namespace detail
}  // namespace kith
