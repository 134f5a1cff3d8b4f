// What people see of a domain: the names of states, and figures of how start pictures look.
#include <algorithm>
#include <stdexcept>

#include "domain_data.hpp"

namespace kith {

void GridFamily::describe_states() {
  const std::size_t num_groups = family_map.groups.size();
  for (std::size_t group = 0; group < num_groups; ++group) {
    const auto is_station = [&](const detail::MapThing& thing) {
      return !family_map.symbols[thing.symbol].content.station.empty();
    };
    const bool only_stations = std::ranges::all_of(family_map.groups[group].things, is_station);
    if (!only_stations) non_station_groups |= family_map.bit_of(group);
  }
  digits_per_state = 2 + 3 * family_map.items.size() + 2 * family_map.stations.size();
  first_state.push_back(0);
  for (const DomainMember& member : members) {
    first_state.push_back(first_state.back() + member.mdp.num_states());
    for (std::size_t s = 0; s < member.mdp.num_states(); ++s) describe_state(member, member.states[s]);
  }
}

// Digits: robot x y; per item of the MDP x y carried; per station still there x y.
void GridFamily::describe_state(const DomainMember& member, detail::PackedState s) {
  const std::size_t row_begin = digits.size();
  const auto add_cell = [&](std::size_t index) {
    const Cell cell = family_map.cell_at(index);
    digits.push_back(cell.x);
    digits.push_back(cell.y);
  };
  add_cell(layout.robot(s));
  for (std::size_t i = 0; i < member.item_present.size(); ++i) {
    if (!member.item_present[i]) continue;
    add_cell(layout.item(s, i));
    digits.push_back(layout.carried(s) == i + 1 ? 1 : 0);
  }
  std::uint16_t stations = 0;
  for (std::size_t i = 0; i < family_map.stations.size(); ++i) {
    if (!layout.has_station(s, i)) continue;
    add_cell(family_map.stations[i].cell);
    ++stations;
  }
  num_stations.push_back(stations);
  num_digits.push_back(static_cast<std::uint16_t>(digits.size() - row_begin));
  digits.resize(row_begin + digits_per_state, 0);
}

std::string Domain::state_name(MdpIndex m, StateIndex s) const {
  if (!data_->has_map()) {
    const Mdp& process = mdp(m);
    if (s.value() < process.num_states() + process.num_terminals()) {
      return data_->model().members[m.value()].names[s.value()];
    }
    throw std::invalid_argument{"Domain::state_name: there is no state " + std::to_string(s.value())};
  }

  const GridMap map{data_->grid()};
  const GridState now = map.state(m, s);
  const std::vector<std::size_t> items = map.items_in(m);
  const auto at = [&](Cell cell) {
    return cell_text(data_->grid().family_map, *data_->grid().family_map.index_of(cell));
  };

  std::string text = now.exited ? "gone from " + at(now.robot) : "robot at " + at(now.robot);
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::string& item = data_->grid().item_names[items[i]];
    text += now.carried[i] ? ", carrying " + item : ", " + item + " at " + at(now.items[i]);
  }
  for (std::size_t i = 0; i < data_->grid().family_map.stations.size(); ++i) {
    const detail::Station& station = data_->grid().family_map.stations[i];
    if (std::ranges::find(now.stations, data_->grid().family_map.cell_at(station.cell)) == now.stations.end()) continue;
    text += ", " + station.name + " at " + cell_text(data_->grid().family_map, station.cell);
  }
  return text;
}

}  // namespace kith
