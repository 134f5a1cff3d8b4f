#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kith/domains/grid_map.hpp"
#include "kith/geometry/half_space.hpp"
#include "kith/mdp/mdp.hpp"

namespace kith {

/// A demonstration candidate, or a test: one start state of one MDP.
struct StartId {
  MdpIndex mdp;
  StateIndex start;
  friend auto operator<=>(const StartId&, const StartId&) = default;
};

/// How reward weights are scaled when a return is shown to people. Nothing else
/// depends on it: a policy depends only on the direction of the weights.
enum class WeightNorm { kL2, kL1 };

/// The robot's reward weights w*, as exact integers up to scale and as a unit vector.
struct RewardWeights {
  std::vector<double> raw;            ///< As written in the file, shape [d].
  IntegerVector integer;              ///< Primitive integer vector in the same direction, exact.
  Direction unit;                     ///< integer / |integer|, shape [d]; empty unless d is 2 to 8.
  WeightNorm norm = WeightNorm::kL2;  ///< Which length return_of() takes as 1.

  /// w . mu with w at length 1: the return of a path with these feature counts.
  /// Counts that are kept in units of 1 / Domain::count_scale() give a return in the same units.
  /// @throws std::invalid_argument unless feature_counts has d entries.
  [[nodiscard]] double return_of(const IntegerVector& feature_counts) const;
};

/// How people call a feature. "{n}" stands for how often it counts.
struct Wording {
  std::string one;      ///< What it is, once: "crossing rubble", "a step on the path". Never empty.
  std::string many;     ///< Several times: "crossing rubble {n} times", "{n} steps on the path". Never empty.
  std::string do_one;   ///< What the robot does, as a verb: "cross rubble"; empty: nobody said.
  std::string do_many;  ///< The same several times: "cross rubble {n} times"; empty exactly where do_one is.
  friend bool operator==(const Wording&, const Wording&) = default;
};

/// Something that the condition of a feature names: in "leave:charger" the verb "leave", the kind "station" and the
/// name "charger".
struct FeatureThing {
  std::string verb;  ///< "leave", "enter", "carrying", "deliver" or "goal".
  std::string kind;  ///< "terrain", "station", "item" or "goal".
  std::string name;
  friend bool operator==(const FeatureThing&, const FeatureThing&) = default;
};

/// What weights say of a robot that nobody gave any: they were inferred from what it does (`kith infer`).
struct InferredWeights {
  double share = 1.0;        ///< Of what the robot does, the share that is best under the weights, in (0, 1].
  double loss = 0.0;         ///< What its actions give away under them, mean over states, at length 1; >= 0.
  double margin = 0.0;       ///< Sine of the angle to the nearest weights that explain less, >= 0.
  std::size_t left_out = 0;  ///< Starts that are not used, because the robot's way from there is not explained.
  /// States in which the robot does something else than what is best, or was not seen; ascending.
  std::vector<StartId> not_explained{};
  friend bool operator==(const InferredWeights&, const InferredWeights&) = default;
};

/// Things that are there or not together: one bit of an MDP's index.
struct OptionalGroup {
  std::string name;         ///< What it is: "rubble", "charger".
  std::vector<Cell> cells;  ///< In reading order.
};

/// A family of MDPs that share actions, features, reward weights and discount:
/// gridworlds that differ in which optional things are on the map, or an explicit
/// model of one or several MDPs.
///
/// In gridworlds MDP m's things are the bits of m, the first optional group in the most
/// significant bit; where the file builds only some of the family, present_things()
/// knows them. Immutable and self-contained: a value.
class Domain {
 public:
  struct Data;  ///< Made by the reader of domain files.
  explicit Domain(Data data);
  Domain(const Domain&);
  Domain(Domain&&) noexcept;
  Domain& operator=(const Domain&);
  Domain& operator=(Domain&&) noexcept;
  ~Domain();

  [[nodiscard]] const std::string& id() const noexcept;
  [[nodiscard]] const std::string& title() const noexcept;
  /// The robot's job in one sentence, for people who are taught; empty if the file does not say.
  [[nodiscard]] const std::string& goal() const noexcept;
  [[nodiscard]] std::size_t num_features() const noexcept;
  [[nodiscard]] const std::vector<std::string>& feature_names() const noexcept;
  [[nodiscard]] const std::vector<std::string>& action_names() const noexcept;
  /// How people call feature k ("crossing rubble"); its name if the file gives no words.
  [[nodiscard]] const std::string& feature_words(std::size_t k) const;
  /// All that the file says about how people call feature k, completed by rule where it says less.
  [[nodiscard]] const Wording& wording(std::size_t k) const;
  /// What has to be there for feature k to count, by its condition (`when`), in the order in which that names it; not
  /// what must not be there. Empty without a map.
  [[nodiscard]] const std::vector<FeatureThing>& feature_things(std::size_t k) const;
  /// Empty vectors of a domain that was read without (RewardOf::kNobody).
  [[nodiscard]] const RewardWeights& weights() const noexcept;
  /// Where the weights come from if nobody wrote them down; nothing otherwise.
  [[nodiscard]] const std::optional<InferredWeights>& inferred() const noexcept;
  /// What every learner is assumed to know; all hold at the weights. Empty for a single feature.
  [[nodiscard]] const std::vector<HalfSpace>& prior() const noexcept;
  [[nodiscard]] std::size_t max_steps() const noexcept;

  [[nodiscard]] std::size_t num_mdps() const noexcept;
  /// Whether all MDPs are deterministic and undiscounted with integer features: then feature counts are exact.
  [[nodiscard]] bool is_exact() const noexcept;
  /// Feature counts, and expectations of them, are kept as integers in units of 1 / count_scale(): 1 if
  /// is_exact(), else 2^24 where features stay below 2^8, and a smaller power of two where they are larger.
  [[nodiscard]] std::int64_t count_scale() const noexcept;
  /// The states of MDP m in which demonstrations and tests may start, ascending: all that are not terminal, unless the
  /// file asks for fewer. The initial one is among them, unless it is one of those that inferred weights leave out.
  [[nodiscard]] const std::vector<StateIndex>& starts(MdpIndex m) const;
  /// Number of (MDP, start) pairs.
  [[nodiscard]] std::size_t num_starts() const noexcept;
  [[nodiscard]] const Mdp& mdp(MdpIndex m) const;
  /// The state in which a robot first enters MDP m (the map's start, or what the model calls initial).
  [[nodiscard]] StateIndex initial_state(MdpIndex m) const;
  /// Which optional groups are there, in legend order and within a symbol in reading order. Empty without a map.
  [[nodiscard]] std::vector<bool> present_things(MdpIndex m) const;
  /// The optional things that MDP m has, in words: "rubble@{(2,1),(2,2)} charger@{}". Here cells are
  /// (column, row) from the top left, as in all messages about domain files. Without a map the name of the MDP.
  [[nodiscard]] std::string describe_world(MdpIndex m) const;
  /// What people call MDP m; empty if the file gives it no name.
  [[nodiscard]] std::string world_name(MdpIndex m) const;
  /// The MDP of this number or name, in any case; nothing if there is none.
  [[nodiscard]] std::optional<MdpIndex> find_world(std::string_view number_or_name) const;
  /// The optional groups in the order of present_things().
  [[nodiscard]] std::vector<OptionalGroup> optional_groups() const;

  /// A state in words, also a terminal one: "robot at (2,1), carrying the parcel". Cells are (column, row) from the top
  /// left, as in all messages. Without a map the name that the model gives it. @throws std::invalid_argument if there
  /// is no such state.
  [[nodiscard]] std::string state_name(MdpIndex m, StateIndex s) const;

  /// What files call a state: on a map its number, as in tables; else the key that the model gives it, which several
  /// MDPs may share. @throws std::invalid_argument if there is no such state.
  [[nodiscard]] std::string state_key(MdpIndex m, StateIndex s) const;
  /// The keys of all states of a model, also of those that are left out; empty on a map.
  [[nodiscard]] const std::vector<std::string>& model_keys() const noexcept;

  /// The map, if the MDPs are gridworlds on one; nothing for an explicit model that was given state by state. It refers
  /// to the domain, which has to stay (it may be moved).
  [[nodiscard]] std::optional<GridMap> map() const noexcept;
  /// What people see of the MDPs: map(), or the picture that an explicit model comes with; nothing without either.
  [[nodiscard]] std::optional<GridMap> drawing() const noexcept;

  /// How much there is to look at: optional things present in the start state
  /// (terrain cells and stations that are toggled, plus stations still there). 0 without a map.
  [[nodiscard]] int complexity(StartId start) const;
  /// How different two start pictures are:
  ///   2 * sum |differences of the state's coordinates and flags| (over their common length)
  ///   + number of optional groups other than stations that differ + |difference of station counts|.
  /// Without a map: 2 * sum |differences of the states' variables| (without variables: 2 for different states),
  /// plus 1 for different MDPs.
  [[nodiscard]] int dissimilarity(StartId a, StartId b) const;

 private:
  std::unique_ptr<const Data> data_;
};

}  // namespace kith
