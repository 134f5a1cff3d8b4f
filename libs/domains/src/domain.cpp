#include "kith/domains/domain.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "domain_data.hpp"
#include "kith/mdp/behaviour.hpp"

namespace kith {
namespace {

// Units of expected counts: 2^-24, or as much larger as leaves room for episodes of 2^21 steps below the 2^53 units up
// to which doubles count.
std::int64_t expectation_scale(double largest_feature) {
  std::int64_t scale = std::int64_t{1} << 24;
  while (scale > 1 && largest_feature * static_cast<double>(scale) > 0x1p32) scale /= 2;
  return scale;
}

[[noreturn]] void refuse_mdp(MdpIndex m, const char* function) {
  throw std::invalid_argument{std::string{function} + ": there is no MDP " + std::to_string(m.value())};
}

[[noreturn]] void refuse_start(StartId start, const char* function) {
  throw std::invalid_argument{std::string{function} + ": there is no start state " +
                              std::to_string(start.start.value())};
}

// visit(member) of either kind.
template <typename Visit>
decltype(auto) visit_member(const Domain::Data& data, MdpIndex m, const char* function, const Visit& visit) {
  return std::visit(
      [&](const auto& family) -> decltype(auto) {
        if (m.value() >= family.members.size()) refuse_mdp(m, function);
        return visit(family.members[m.value()]);
      },
      data.family);
}

void check_mdp(const Domain::Data& data, MdpIndex m, const char* function) {
  visit_member(data, m, function, [](const auto&) {});
}

const Mdp& mdp_of(const Domain::Data& data, MdpIndex m, const char* function) {
  return visit_member(data, m, function, [](const auto& member) -> const Mdp& { return member.mdp; });
}

// Called in inner loops, so what it rarely does is elsewhere.
template <typename Family>
void check_start(const Family& family, StartId start, const char* function) {
  if (start.mdp.value() >= family.members.size()) refuse_mdp(start.mdp, function);
  if (start.start.value() >= family.members[start.mdp.value()].mdp.num_states()) refuse_start(start, function);
}

std::size_t row_of(const GridFamily& grid, StartId start) {
  return grid.first_state[start.mdp.value()] + start.start.value();
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
const std::string& Domain::goal() const noexcept { return data_->goal; }
std::size_t Domain::num_features() const noexcept { return data_->feature_names.size(); }
const std::vector<std::string>& Domain::feature_names() const noexcept { return data_->feature_names; }
const std::vector<std::string>& Domain::action_names() const noexcept { return data_->action_names; }
const std::string& Domain::feature_words(std::size_t k) const { return wording(k).one; }
const Wording& Domain::wording(std::size_t k) const { return data_->wordings.at(k); }
const std::vector<FeatureThing>& Domain::feature_things(std::size_t k) const {
  static const std::vector<FeatureThing> kNone;
  return k < data_->feature_things.size() ? data_->feature_things[k] : kNone;
}
const RewardWeights& Domain::weights() const noexcept { return data_->weights; }
const std::optional<InferredWeights>& Domain::inferred() const noexcept { return data_->inferred; }
const std::vector<HalfSpace>& Domain::prior() const noexcept { return data_->prior; }
std::size_t Domain::max_steps() const noexcept { return data_->max_steps; }
std::size_t Domain::num_mdps() const noexcept {
  const auto* grid = std::get_if<GridFamily>(&data_->family);
  return grid != nullptr ? grid->members.size() : std::get_if<ExplicitFamily>(&data_->family)->members.size();
}
std::size_t Domain::num_starts() const noexcept { return data_->num_starts; }
bool Domain::is_exact() const noexcept { return data_->exact; }
std::int64_t Domain::count_scale() const noexcept { return data_->count_scale; }
const Mdp& Domain::mdp(MdpIndex m) const { return mdp_of(*data_, m, "Domain::mdp"); }

std::optional<GridMap> Domain::map() const noexcept {
  const auto* grid = std::get_if<GridFamily>(&data_->family);
  return grid == nullptr ? std::nullopt : std::optional{GridMap{*grid}};
}

std::optional<GridMap> Domain::drawing() const noexcept {
  const auto* model = std::get_if<ExplicitFamily>(&data_->family);
  if (model == nullptr) return map();
  return model->drawing ? std::optional{GridMap{*model->drawing}} : std::nullopt;
}

StateIndex Domain::initial_state(MdpIndex m) const {
  check_mdp(*data_, m, "Domain::initial_state");
  if (data_->has_map()) return StateIndex{0};  // the search starts there
  return data_->model().members[m.value()].initial;
}

const std::vector<StateIndex>& Domain::starts(MdpIndex m) const {
  return visit_member(
      *data_, m, "Domain::starts", [](const auto& member) -> const auto& { return member.starts; });
}

std::string Domain::state_key(MdpIndex m, StateIndex s) const {
  check_mdp(*data_, m, "Domain::state_key");
  const Mdp& mdp_of_state = mdp(m);
  if (s.value() >= mdp_of_state.num_states() + mdp_of_state.num_terminals()) refuse_start({m, s}, "Domain::state_key");
  if (data_->has_map()) return std::to_string(s.value());
  return data_->model().keys[data_->model().members[m.value()].keys[s.value()]];
}

const std::vector<std::string>& Domain::model_keys() const noexcept {
  static const std::vector<std::string> kNone;
  const auto* model = std::get_if<ExplicitFamily>(&data_->family);
  return model == nullptr ? kNone : model->keys;
}

std::vector<bool> Domain::present_things(MdpIndex m) const {
  check_mdp(*data_, m, "Domain::present_things");
  std::vector<bool> bits;
  if (!data_->has_map()) return bits;
  for (std::size_t g = 0; g < data_->grid().family_map.groups.size(); ++g)
    bits.push_back(data_->grid().family_map.is_on(g, m.value()));
  return bits;
}

std::string Domain::describe_world(MdpIndex m) const {
  check_mdp(*data_, m, "Domain::describe_world");
  if (!data_->has_map()) return data_->model().members[m.value()].name;
  return world_text(data_->grid().family_map, m.value());
}

std::string Domain::world_name(MdpIndex m) const {
  check_mdp(*data_, m, "Domain::world_name");
  if (!data_->has_map()) return data_->model().members[m.value()].name;
  const auto& names = data_->grid().family_map.world_names;
  return names.empty() ? std::string{} : names[m.value()];
}

std::optional<MdpIndex> Domain::find_world(std::string_view number_or_name) const {
  const auto lower = [](std::string_view text) {
    std::string result{text};
    for (char& c : result) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
    return result;
  };
  const auto wanted = lower(number_or_name);
  for (MdpIndex m{0}; m.value() < num_mdps(); ++m) {
    if (std::to_string(m.value()) == wanted) return m;
  }
  for (MdpIndex m{0}; m.value() < num_mdps() && !wanted.empty(); ++m) {
    if (lower(world_name(m)) == wanted) return m;
  }
  return std::nullopt;
}

std::vector<OptionalGroup> Domain::optional_groups() const {
  if (!data_->has_map()) return {};
  const detail::FamilyMap& family_map = data_->grid().family_map;
  std::vector<OptionalGroup> groups;
  for (const detail::CellGroup& group : family_map.groups) {
    OptionalGroup& added = groups.emplace_back();
    for (const detail::MapThing& thing : group.things) added.cells.push_back(family_map.cell_at(thing.cell));
    if (!group.things.empty()) added.name = symbol_name(family_map.symbols[group.things.front().symbol]);
  }
  return groups;
}

namespace {

int complexity_of(const GridFamily& grid, StartId start) {
  return grid.members[start.mdp.value()].num_toggled + grid.num_stations[row_of(grid, start)];
}

int complexity_of(const ExplicitFamily&, StartId) { return 0; }

int dissimilarity_of(const GridFamily& grid, StartId a, StartId b) {
  const std::size_t row_a = row_of(grid, a);
  const std::size_t row_b = row_of(grid, b);
  const std::size_t common = std::min<std::size_t>(grid.num_digits[row_a], grid.num_digits[row_b]);
  const std::int32_t* digits_a = grid.digits.data() + row_a * grid.digits_per_state;
  const std::int32_t* digits_b = grid.digits.data() + row_b * grid.digits_per_state;
  int moved = 0;
  for (std::size_t i = 0; i < common; ++i) moved += std::abs(digits_a[i] - digits_b[i]);
  const detail::FamilyMap& family_map = grid.family_map;
  const std::uint64_t toggled =
      (family_map.mask(a.mdp.value()) ^ family_map.mask(b.mdp.value())) & grid.non_station_groups;
  const int stations = grid.num_stations[row_a] - grid.num_stations[row_b];
  return 2 * moved + std::popcount(toggled) + std::abs(stations);
}

int dissimilarity_of(const ExplicitFamily& model, StartId a, StartId b) {
  const ExplicitMember& member_a = model.members[a.mdp.value()];
  const ExplicitMember& member_b = model.members[b.mdp.value()];
  const std::size_t num_variables = model.variables.size();
  constexpr std::int64_t kFarthest = 1'000'000'000;
  std::int64_t moved = member_a.keys[a.start.value()] == member_b.keys[b.start.value()] ? 0 : 1;
  if (num_variables > 0) {
    moved = 0;
    for (std::size_t v = 0; v < num_variables; ++v) {
      moved += std::abs(std::int64_t{member_a.variables[a.start.value() * num_variables + v]} -
                        member_b.variables[b.start.value() * num_variables + v]);
    }
  }
  return static_cast<int>(2 * std::min(moved, kFarthest)) + (a.mdp == b.mdp ? 0 : 1);
}

}  // namespace

int Domain::complexity(StartId start) const {
  return std::visit(
      [&](const auto& family) {
        check_start(family, start, "Domain::complexity");
        return complexity_of(family, start);
      },
      data_->family);
}

int Domain::dissimilarity(StartId a, StartId b) const {
  return std::visit(
      [&](const auto& family) {
        check_start(family, a, "Domain::dissimilarity");
        check_start(family, b, "Domain::dissimilarity");
        return dissimilarity_of(family, a, b);
      },
      data_->family);
}

void Domain::Data::sum_up() {
  double largest = 0.0;
  std::visit(
      [&](const auto& family_of_either_kind) {
        for (const auto& member : family_of_either_kind.members) {
          num_starts += member.starts.size();
          exact = exact && kith::is_exact(member.mdp);
          largest = std::max(largest, member.mdp.largest_feature());
        }
      },
      family);
  count_scale = exact ? 1 : expectation_scale(largest);
}

}  // namespace kith
