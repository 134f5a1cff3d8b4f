#include "kith/domains/domain.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "domain_data.hpp"

namespace kith {
namespace {

constexpr std::int64_t kExpectationScale = std::int64_t{1} << 24;

const DomainMember& member_of(const Domain::Data& data, MdpIndex m, const char* function) {
  if (m.value() < data.members.size()) return data.members[m.value()];
  throw std::invalid_argument{std::string{function} + ": there is no MDP " + std::to_string(m.value())};
}

std::size_t row_of(const Domain::Data& data, DemoId demo, const char* function) {
  const DomainMember& member = member_of(data, demo.mdp, function);
  if (demo.start.value() < member.mdp.num_states()) return data.first_start[demo.mdp.value()] + demo.start.value();
  throw std::invalid_argument{std::string{function} + ": there is no start state " +
                              std::to_string(demo.start.value())};
}

}  // namespace

double RewardWeights::return_of(const IntegerVector& feature_counts) const {
  if (feature_counts.size() != integer.size()) {
    throw std::invalid_argument{"RewardWeights::return_of: there must be one count per feature"};
  }
  double length = 0.0;
  for (const std::int64_t entry : integer) {
    const auto x = static_cast<double>(entry);
    length += norm == WeightNorm::kL1 ? std::abs(x) : x * x;
  }
  if (norm == WeightNorm::kL2) length = std::sqrt(length);
  return static_cast<double>(dot(integer, feature_counts)) / length;
}

Domain::Domain(Data data) : data_{std::make_unique<const Data>(std::move(data))} {}
Domain::Domain(const Domain& other) : data_{std::make_unique<const Data>(*other.data_)} {}
Domain::Domain(Domain&&) noexcept = default;
Domain& Domain::operator=(const Domain& other) { return *this = Domain{other}; }
Domain& Domain::operator=(Domain&&) noexcept = default;
Domain::~Domain() = default;

const std::string& Domain::id() const noexcept { return data_->id; }
const std::string& Domain::title() const noexcept { return data_->title; }
std::size_t Domain::num_features() const noexcept { return data_->feature_names.size(); }
const std::vector<std::string>& Domain::feature_names() const noexcept { return data_->feature_names; }
const std::vector<std::string>& Domain::action_names() const noexcept { return data_->action_names; }
const std::string& Domain::feature_words(std::size_t k) const { return data_->feature_words.at(k); }
const RewardWeights& Domain::weights() const noexcept { return data_->weights; }
const std::vector<HalfSpace>& Domain::prior() const noexcept { return data_->prior; }
std::size_t Domain::max_steps() const noexcept { return data_->max_steps; }
std::size_t Domain::num_mdps() const noexcept { return data_->members.size(); }
std::size_t Domain::num_starts() const noexcept { return data_->num_starts; }
bool Domain::is_exact() const noexcept { return data_->exact; }
std::int64_t Domain::count_scale() const noexcept { return data_->exact ? 1 : kExpectationScale; }
bool Domain::has_map() const noexcept { return true; }
const Mdp& Domain::mdp(MdpIndex m) const { return member_of(*data_, m, "Domain::mdp").mdp; }
int Domain::width() const noexcept { return data_->world.width; }
int Domain::height() const noexcept { return data_->world.height; }
const std::vector<std::string>& Domain::item_names() const noexcept { return data_->item_names; }

StateIndex Domain::initial_state(MdpIndex m) const {
  static_cast<void>(member_of(*data_, m, "Domain::initial_state"));
  return StateIndex{0};  // the search starts there
}

const std::vector<StateIndex>& Domain::starts(MdpIndex m) const {
  return member_of(*data_, m, "Domain::starts").starts;
}

std::vector<bool> Domain::variant(MdpIndex m) const {
  static_cast<void>(member_of(*data_, m, "Domain::variant"));
  std::vector<bool> bits;
  for (std::size_t g = 0; g < data_->world.groups.size(); ++g) bits.push_back(data_->world.is_on(g, m.value()));
  return bits;
}

std::string Domain::describe_variant(MdpIndex m) const {
  static_cast<void>(member_of(*data_, m, "Domain::describe_variant"));
  return variant_text(data_->world, m.value());
}

bool Domain::has_feature(MdpIndex m, std::size_t k) const {
  const DomainMember& member = member_of(*data_, m, "Domain::has_feature");
  if (k >= num_features()) throw std::invalid_argument{"Domain::has_feature: there is no feature " + std::to_string(k)};
  return k + 1 == num_features() || member.mdp.has_feature(k);
}

CellContent Domain::content(MdpIndex m, Cell cell) const {
  static_cast<void>(member_of(*data_, m, "Domain::content"));
  const auto index = data_->world.index_of(cell);
  if (!index) throw std::invalid_argument{"Domain::content: the cell is off the map"};
  if (!data_->world.is_present(*index, m.value())) return {};
  const detail::SymbolContent& content = data_->world.content(*index);
  return {content.wall, content.goal, content.terrain, content.destination};
}

std::vector<std::size_t> Domain::items_in(MdpIndex m) const {
  const DomainMember& member = member_of(*data_, m, "Domain::items_in");
  std::vector<std::size_t> items;
  for (std::size_t i = 0; i < member.item_present.size(); ++i) {
    if (member.item_present[i]) items.push_back(i);
  }
  return items;
}

GridState Domain::state(MdpIndex m, StateIndex s) const {
  const DomainMember& member = member_of(*data_, m, "Domain::state");
  if (s.value() >= member.states.size()) {
    throw std::invalid_argument{"Domain::state: there is no state " + std::to_string(s.value())};
  }
  const detail::PackedState packed = member.states[s.value()];
  const detail::World& world = data_->world;
  GridState state;
  state.robot = world.cell_at(data_->layout.robot(packed));
  for (std::size_t i = 0; i < member.item_present.size(); ++i) {
    if (!member.item_present[i]) continue;
    state.items.push_back(world.cell_at(data_->layout.item(packed, i)));
    state.carried.push_back(data_->layout.carried(packed) == i + 1);
  }
  for (std::size_t i = 0; i < world.stations.size(); ++i) {
    if (data_->layout.has_station(packed, i)) state.stations.push_back(world.cell_at(world.stations[i].cell));
  }
  state.exited = data_->layout.exited(packed);
  return state;
}

std::optional<StateIndex> Domain::find_state(MdpIndex m, const GridState& state) const {
  const DomainMember& member = member_of(*data_, m, "Domain::find_state");
  const detail::World& world = data_->world;
  const auto robot = world.index_of(state.robot);
  const std::vector<std::size_t> items = items_in(m);
  if (!robot || state.items.size() != items.size() || state.carried.size() != items.size()) return std::nullopt;
  detail::PackedState packed = data_->layout.with_robot(0, *robot);
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto cell = world.index_of(state.items[i]);
    if (!cell) return std::nullopt;
    packed = data_->layout.with_item(packed, items[i], *cell);
    if (state.carried[i]) packed = data_->layout.with_carried(packed, items[i] + 1);
  }
  std::uint64_t stations = 0;
  for (std::size_t i = 0; i < world.stations.size(); ++i) {
    const Cell cell = world.cell_at(world.stations[i].cell);
    if (std::ranges::find(state.stations, cell) != state.stations.end()) stations |= std::uint64_t{1} << i;
  }
  packed = data_->layout.with_stations(packed, stations);
  if (state.exited) packed = data_->layout.with_exit(packed);

  const auto it =
      std::ranges::lower_bound(member.by_state, packed, {}, [&](std::uint32_t s) { return member.states[s]; });
  // Comparing the whole state also refuses what the packing cannot express.
  if (it == member.by_state.end() || this->state(m, StateIndex{*it}) != state) return std::nullopt;
  return StateIndex{*it};
}

int Domain::complexity(DemoId demo) const {
  const std::size_t row = row_of(*data_, demo, "Domain::complexity");
  return data_->members[demo.mdp.value()].num_toggled + data_->num_stations[row];
}

int Domain::dissimilarity(DemoId a, DemoId b) const {
  const std::size_t row_a = row_of(*data_, a, "Domain::dissimilarity");
  const std::size_t row_b = row_of(*data_, b, "Domain::dissimilarity");
  const std::size_t common = std::min<std::size_t>(data_->num_digits[row_a], data_->num_digits[row_b]);
  const std::int32_t* digits_a = data_->digits.data() + row_a * data_->digits_per_start;
  const std::int32_t* digits_b = data_->digits.data() + row_b * data_->digits_per_start;
  int moved = 0;
  for (std::size_t i = 0; i < common; ++i) moved += std::abs(digits_a[i] - digits_b[i]);
  const detail::World& world = data_->world;
  const std::uint64_t toggled =
      (world.variant(a.mdp.value()) ^ world.variant(b.mdp.value())) & data_->non_station_groups;
  const int stations = data_->num_stations[row_a] - data_->num_stations[row_b];
  return 2 * moved + std::popcount(toggled) + std::abs(stations);
}

}  // namespace kith
