// The same robot said in another way is the same robot: features in another order, weights at another scale, the map
// turned over, other names, a feature that never occurs, a copy of a feature, a world listed twice. And what is nearly
// the same robot, with a little discount or chance, is taught without nonsense.
#include <gtest/gtest.h>

#include <cmath>
#include <exception>
#include <functional>

#include "facts.hpp"
#include "kith/core/error.hpp"
#include "kith/explain/question.hpp"
#include "kith/explain/target.hpp"
#include "kith/geometry/cone.hpp"
#include "kith/study/study.hpp"
#include "random_domains.hpp"
#include "rewriting.hpp"

namespace kith::laws {
namespace {

// --- domains ---------------------------------------------------------------------------------------------------------

// Takes seconds each, in every way in which they can be said.
bool is_large(const std::string& name) {
  return name == "navigation" || name == "rescue-floor" || name == "warehouse" || name == "taxi" ||
         name == "frozen-lake-8x8" || name == "colored-tiles" || name == "four-rooms";
}

std::vector<DomainText> known(bool with_large) {
  std::vector<DomainText> result;
  for (auto& known_domain : known_domains()) {
    if (with_large || !is_large(known_domain.name)) result.push_back(std::move(known_domain));
  }
  return result;
}

// Half of them maps, half of them models with and without chance and discount.
std::vector<DomainText> random_domains(std::size_t n, std::uint64_t seed) {
  std::vector<DomainText> result;
  for (std::size_t i = 0; i < n; ++i) {
    const auto random = RandomStream{seed}.split(i);
    result.push_back(i % 2 == 0   ? random_map(random)
                     : i % 8 == 1 ? random_model(random, 0.0, 0.9)
                     : i % 4 == 3 ? random_model(random, 0.2)
                                  : random_model(random, 0.0));
    result.back().name += "-" + std::to_string(i);
  }
  return result;
}

bool has_warning(const DomainReading& reading, std::string_view id) {
  return std::any_of(reading.diagnostics.begin(), reading.diagnostics.end(), [&](const auto& d) { return d.id == id; });
}

// The domain of a text that must be sound.
struct Read {
  explicit Read(const DomainText& text) : reading{text.read()} {
    if (reading.domain) return;
    std::string all;
    for (const auto& diagnostic : reading.diagnostics) all += to_text(diagnostic) + "\n";
    throw std::runtime_error{"not sound: " + all + text.toml()};
  }
  DomainReading reading;
};

// --- comparisons -----------------------------------------------------------------------------------------------------

bool all_states_are_starts(const Domain& domain) {
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    if (domain.starts(m).size() != domain.mdp(m).num_states()) return false;
  }
  return true;
}

// Expectations may differ by their rounding.
void expect_close(const std::vector<IntegerVector>& a, const std::vector<IntegerVector>& b, std::int64_t units) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < a[i].size(); ++k) {
      ASSERT_LE(std::abs(a[i][k] - b[i][k]), units) << to_string(a[i]) << " and " << to_string(b[i]);
    }
  }
}

// What `inspect` and `find` show.
void expect_same_facts(const Atlas& original, const Atlas& other, const Rewriting& rewriting) {
  const auto& domain = original.domain();
  const auto facts = facts_of(original, rewriting.counts), others = facts_of(other, identity(other.domain()));
  EXPECT_EQ(facts.num_worlds, others.num_worlds);
  EXPECT_EQ(domain.is_exact(), other.domain().is_exact());
  if (domain.is_exact() || rewriting.same_vectors) {
    EXPECT_EQ(facts.counts, others.counts);
  } else {
    expect_close(facts.counts, others.counts, 2);
  }
  // What is compared beside the robot's paths is sampled where not every state is a start; and constraints of
  // expectations are rounded, to other ones if the last bit differs.
  const bool are_tabulated = original.find_tables() && other.find_tables();
  const bool is_region_exact = domain.is_exact() && (are_tabulated || all_states_are_starts(domain));
  if (rewriting.same_vectors || is_region_exact) {
    EXPECT_EQ(facts.region, others.region);
  }
  if (!rewriting.same_features) return;
  const auto error = original.policy_bec_area().standard_error + other.policy_bec_area().standard_error;
  const bool is_sampled = !rewriting.same_vectors && !all_states_are_starts(domain) && !are_tabulated;
  if (!is_sampled) {
    EXPECT_NEAR(original.policy_bec_area_sr(), other.policy_bec_area_sr(), 1e-4 + 4.0 * error);
  }
  // On a map that is turned over the robot may take another of equal paths, past other cells.
  if (rewriting.same_states && (rewriting.same_vectors || is_region_exact)) {
    EXPECT_EQ(facts.mask_counters, others.mask_counters);
    EXPECT_EQ(isolations_of(original, rewriting.counts), isolations_of(other, identity(other.domain())));
  }
  // Beyond three features, what gets a lesson of its own is sampled; between equal features their order decides, and on
  // a map that is turned over they can be met more or less often.
  const bool has_few = domain.num_features() <= 3 && domain.is_exact() && !has_equal_counters(original);
  if ((rewriting.same_vectors && rewriting.same_states) || has_few) {
    EXPECT_EQ(facts.components, others.components);
  }
  EXPECT_EQ(original.knowledge_components().back().features.size(),
            other.knowledge_components().back().features.size());
}

std::optional<Curriculum> curriculum_of(const Atlas& atlas) {
  CurriculumOptions options;
  options.beliefs = 300;
  options.teaching.filter.particles = 300;
  try {
    return make_curriculum(atlas, options);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInfeasible) << error.what();
    return std::nullopt;
  }
}

// What all lessons show implies every component, also one that got no lesson of its own.
void expect_all_is_known(const Atlas& atlas, const Curriculum& curriculum) {
  Cone known = atlas.prior_cone();
  for (const auto& component : curriculum.components) {
    for (const auto& shown : component.demonstrations) ASSERT_TRUE(known.clip(shown.conveys));
  }
  for (const auto& component : atlas.knowledge_components()) {
    for (const auto& constraint : atlas.constraints().half_spaces(component.constraints))
      EXPECT_TRUE(known.implies(constraint)) << to_string(constraint.normal());
  }
}

void expect_same_lessons(const Atlas& original, const Atlas& other, const Rewriting& rewriting) {
  const auto curriculum = curriculum_of(original), others = curriculum_of(other);
  ASSERT_EQ(curriculum.has_value(), others.has_value());
  if (!curriculum) return;
  const auto facts = taught_facts(original, *curriculum, rewriting.counts);
  const auto other_facts = taught_facts(other, *others, identity(other.domain()));
  if (!rewriting.same_vectors || !rewriting.same_states) {
    // People are drawn, so that an earlier lesson may happen to show what another shows later: then nothing is left.
    EXPECT_EQ(facts.all(), other_facts.all());
    if (facts == other_facts) return;
    expect_all_is_known(original, *curriculum);
    expect_all_is_known(other, *others);
    return;
  }
  EXPECT_EQ(facts, other_facts);
  ASSERT_EQ(curriculum->components.size(), others->components.size());
  for (std::size_t c = 0; c < curriculum->components.size(); ++c) {
    const auto &a = curriculum->components[c], &b = others->components[c];
    EXPECT_EQ(a.constraints, b.constraints);
    ASSERT_EQ(a.demonstrations.size(), b.demonstrations.size());
    for (std::size_t i = 0; i < a.demonstrations.size(); ++i) {
      EXPECT_EQ(a.demonstrations[i].start, b.demonstrations[i].start);
      EXPECT_EQ(a.demonstrations[i].conveys, b.demonstrations[i].conveys);
    }
    ASSERT_EQ(a.tests.size(), b.tests.size());
    for (std::size_t i = 0; i < a.tests.size(); ++i) {
      EXPECT_EQ(a.tests[i].start, b.tests[i].start);
      EXPECT_EQ(a.tests[i].share_right, b.tests[i].share_right);
    }
  }
}

// --- the laws --------------------------------------------------------------------------------------------------------

std::vector<Rewriting> rewritings(const DomainText& text, const RandomStream& random) {
  std::vector<std::optional<Rewriting>> all{with_features_permuted(text, random.split("first order")),
                                            with_features_permuted(text, random.split("second order")), mirrored(text),
                                            transposed(text), renamed(text)};
  // Exactly representable ones, and awkward ones.
  for (const double factor : {2.0, 0.3, 1e-9, 7e9}) all.push_back(with_weights_scaled(text, factor));
  std::vector<Rewriting> result;
  for (auto& one : all) {
    if (one) result.push_back(*std::move(one));
  }
  return result;
}

using Comparison = std::function<void(const Atlas& original, const Atlas& other, const Rewriting& rewriting)>;

void compare(const DomainText& text, const std::vector<Rewriting>& ways, const Comparison& same) {
  SCOPED_TRACE(text.name);
  const Read read{text};
  if (read.reading.domain->num_features() < 2) return;
  const Atlas original{*read.reading.domain};
  const bool has_equal_paths = has_warning(read.reading, "W0302");
  for (const auto& way : ways) {
    // On a map that is turned over the robot may take another of equally good paths.
    if (!way.same_states && has_equal_paths) continue;
    // And what it takes as good as another counts as a constraint with tables only, for which there are features too
    // many.
    if (!way.same_features && has_equal_paths) continue;
    SCOPED_TRACE(way.how);
    try {
      const Atlas other{*Read{way.text}.reading.domain};
      same(original, other, way);
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what();
    }
  }
}

void compare_all(const std::vector<DomainText>& texts, std::uint64_t seed, const Comparison& same) {
  for (const auto& text : texts) compare(text, rewritings(text, RandomStream{seed}.split(text.name)), same);
}

TEST(Metamorphic, WhatIsKnownOfAKnownRobotDoesNotDependOnHowItIsSaid) {
  compare_all(known(false), 1, expect_same_facts);
}

TEST(Metamorphic, WhatIsKnownOfARandomRobotDoesNotDependOnHowItIsSaid) {
  compare_all(random_domains(50, 2), 2, expect_same_facts);
}

void expect_same_lessons_where_nothing_is_sampled(const Atlas& original, const Atlas& other, const Rewriting& way) {
  const bool has_few = original.domain().num_features() == 3 && original.find_tables();
  if ((way.same_vectors && way.same_states) || (has_few && !has_equal_counters(original)))
    expect_same_lessons(original, other, way);
}

TEST(Metamorphic, WhatIsTaughtDoesNotDependOnHowTheRobotIsSaid) {
  std::vector<DomainText> texts = random_domains(8, 3);
  for (auto& one : known(false)) texts.push_back(std::move(one));
  for (const auto& text : texts) {
    const auto random = RandomStream{3}.split(text.name);
    std::vector<Rewriting> ways;
    for (auto& way : {with_features_permuted(text, random), renamed(text), with_weights_scaled(text, 0.3)}) {
      if (way) ways.push_back(*way);
    }
    compare(text, ways, expect_same_lessons_where_nothing_is_sampled);
  }
}

TEST(MetamorphicSlow, NothingDependsOnHowARobotIsSaid) {
  const auto same = [](const Atlas& original, const Atlas& other, const Rewriting& way) {
    expect_same_facts(original, other, way);
    expect_same_lessons_where_nothing_is_sampled(original, other, way);
  };
  compare_all(known(true), 4, same);
  compare_all(random_domains(600, 4), 4, same);
}

void compare_features_added(const std::vector<DomainText>& texts, std::uint64_t seed) {
  for (const auto& text : texts) {
    const auto random = RandomStream{seed}.split(text.name);
    std::vector<Rewriting> ways;
    for (auto& way : {with_a_feature_that_never_occurs(text, random.split("never")),
                      with_a_copy_of_a_feature(text, random.split("copy"))}) {
      if (way) ways.push_back(*way);
    }
    compare(text, ways, expect_same_facts);
  }
}

TEST(Metamorphic, AFeatureThatNeverOccursAndACopyOfAFeatureChangeNothingElse) {
  compare_features_added(random_domains(20, 5), 5);
}

TEST(MetamorphicSlow, AFeatureThatNeverOccursAndACopyOfAFeatureChangeNothingElse) {
  compare_features_added(known(false), 6);
  compare_features_added(random_domains(200, 6), 6);
}

TEST(Metamorphic, AWorldThatIsListedTwiceIsRefusedOnAMapAndChangesNothingElseInAModel) {
  auto listed = known(false).front();
  const auto once = listed.toml();
  const std::string world = "[[family.world]]\nname = \"NAME\"\npresent = [\"rubble\"]\n";
  const auto named = [&](const char* name) { return std::string{world}.replace(world.find("NAME"), 4, name); };
  EXPECT_TRUE(has_warning(parse_domain(once + named("once") + named("again"), "twice.toml"), "E0271")) << listed.name;
  std::vector<DomainText> texts = random_domains(24, 7);
  for (auto& one : known(false)) texts.push_back(std::move(one));
  std::size_t tried = 0;
  for (const auto& text : texts) {
    const auto way = with_a_world_twice(text);
    if (!way) continue;
    ++tried;
    compare(text, {*way}, [](const Atlas& original, const Atlas& other, const Rewriting&) {
      const auto counted = identity(original.domain());
      const auto facts = facts_of(original, counted), others = facts_of(other, counted);
      EXPECT_EQ(others.num_worlds, facts.num_worlds + 1);
      EXPECT_EQ(others.region, facts.region);
      if (counted.size() > 3) return;  // what gets a lesson of its own is sampled
      // Rows of a world that is listed twice count twice, which can change the most frequent feature and the sequence.
      const auto& before = original.mask_counters();
      const auto& after = other.mask_counters();
      for (std::size_t i = 0; i < before.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
          if ((before[i] <=> before[j]) != (after[i] <=> after[j])) return;
        }
      }
      ASSERT_EQ(others.components.size(), facts.components.size());
      for (std::size_t c = 0; c < facts.components.size(); ++c) {
        EXPECT_EQ(others.components[c].features, facts.components[c].features);
        EXPECT_EQ(others.components[c].constraints, facts.components[c].constraints);
      }
    });
  }
  EXPECT_GE(tried, 5u);
}

// --- nearly the same robot -------------------------------------------------------------------------------------------

// Everything that people are shown and told of a robot exists and is in its range.
void expect_sane(const Atlas& atlas) {
  const auto& domain = atlas.domain();
  EXPECT_GT(atlas.policy_bec_area_sr(), 0.0);
  EXPECT_LE(atlas.policy_bec_area_sr(), sphere_area(domain.num_features()) * (1.0 + 1e-9));
  (void)isolated_constraints(atlas);
  if (const auto curriculum = curriculum_of(atlas)) {
    for (const auto& component : curriculum->components) {
      EXPECT_FALSE(component.demonstrations.empty());
      for (const auto& shown : component.demonstrations) {
        EXPECT_FALSE(atlas.trajectory(shown.start).actions.empty()) << "a demonstration of nothing";
        EXPECT_FALSE(shown.reason.empty());
        for (const auto& conveyed : shown.conveys) EXPECT_TRUE(conveyed.contains(domain.weights().integer));
      }
      for (const auto& test : component.tests) {
        EXPECT_GE(test.share_right, 0.0);
        EXPECT_LE(test.share_right, 1.0);
      }
    }
  }
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    for (const std::string kind : {"when ", "when not ", "why ", "how much "}) {
      try {
        const auto reply = answer_question(atlas, kind + domain.feature_names()[k]);
        EXPECT_FALSE(reply.text.empty());
        for (const auto& example : reply.examples) EXPECT_FALSE(example.text.empty());
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput) << error.what();  // such as: it never does
      }
    }
  }
}

void expect_sane_with_discounts(const DomainText& text) {
  SCOPED_TRACE(text.name);
  for (const double discount : {0.99, 0.9, 0.7, 0.3}) {
    SCOPED_TRACE("discount " + std::to_string(discount));
    const Read read{with_discount(text, discount)};
    if (read.reading.domain->num_features() < 2) return;
    expect_sane(Atlas{*read.reading.domain});
  }
}

TEST(Metamorphic, DiscountsMakeNoNonsense) {
  for (const auto& text : known(false)) {
    if (text.name == "two-goals") expect_sane_with_discounts(text);
  }
  expect_sane_with_discounts(robot_that_never_ends());
  for (const auto& text : random_domains(6, 8)) expect_sane_with_discounts(text);
}

TEST(MetamorphicSlow, DiscountsMakeNoNonsense) {
  for (const auto& text : known(false)) expect_sane_with_discounts(text);
  for (const auto& text : random_domains(100, 9)) expect_sane_with_discounts(text);
}

// What the robot expects from its first state.
double value_of(const Atlas& atlas) {
  const auto& domain = atlas.domain();
  const auto start = atlas.index({MdpIndex{0}, domain.initial_state(MdpIndex{0})});
  return domain.weights().return_of(atlas.feature_counts(start)) / static_cast<double>(domain.count_scale());
}

void expect_sane_with_slips(const RandomStream& random) {
  const auto at = [&](double slip) { return Atlas{*Read{random_model(random, slip)}.reading.domain}; };
  const Atlas never = at(0.0), always = at(1.0);
  EXPECT_TRUE(never.domain().is_exact());
  EXPECT_TRUE(always.domain().is_exact());
  // A robot that hardly ever slips, or hardly ever does not, is worth what the limit is worth: at most seven steps, in
  // each of which one action in a million goes elsewhere.
  EXPECT_NEAR(value_of(at(1e-6)), value_of(never), 1e-3);
  EXPECT_NEAR(value_of(at(1.0 - 1e-6)), value_of(always), 1e-3);
  for (const double slip : {0.0, 1e-6, 0.2, 1.0 / 3.0, 0.5, 1.0}) {
    SCOPED_TRACE("slips " + std::to_string(slip));
    expect_sane(at(slip));
  }
}

TEST(Metamorphic, SlipsFromNeverToAlwaysMakeNoNonsense) {
  for (std::uint64_t i = 0; i < 6; ++i) expect_sane_with_slips(RandomStream{10}.split(i));
}

TEST(MetamorphicSlow, SlipsFromNeverToAlwaysMakeNoNonsense) {
  for (std::uint64_t i = 0; i < 100; ++i) expect_sane_with_slips(RandomStream{11}.split(i));
}

// --- studies ---------------------------------------------------------------------------------------------------------

struct Sample {
  double n = 0.0, sum = 0.0, squares = 0.0;
  void add(double x) {
    n += 1.0;
    sum += x;
    squares += x * x;
  }
  [[nodiscard]] double mean() const { return sum / n; }
  [[nodiscard]] double variance_of_mean() const { return std::max(0.0, squares / n - mean() * mean()) / (n - 1.0); }
};

struct Outcomes {
  Sample periods, knowledge, skipped;
};

Outcomes study_of(const Atlas& atlas, std::size_t replicates, std::uint64_t seed) {
  StudySpec spec;
  spec.id = "law";
  spec.seed = seed;
  spec.replicates = replicates;
  take_domain(spec, atlas.domain());
  spec.strategies = {strategy_named("common")};
  spec.compositions = {"N"};
  LearnerType type{.letter = 'N', .label = {}};
  type.parameters.set("ability.mean", 0.75);
  type.parameters.set("ability.sd", 0.03);
  type.parameters.set("confirm_gain", Spread{.half_normal = {}, .value = 0.03});
  type.parameters.set("correct_gain", Spread{.half_normal = {}, .value = 0.05});
  type.parameters.set("particles", std::int64_t{300});
  spec.learner_types = {type};
  spec.teaching.filter.particles = 300;
  spec.record = RecordLevel::kTeam;
  const Study study{{spec}};
  Outcomes outcomes;
  for (const auto& team : run_teams(atlas, study, team_addresses(study), {.threads = 1, .on_progress = {}}).teams) {
    outcomes.periods.add(static_cast<double>(team.periods));
    outcomes.knowledge.add(team.knowledge);
    outcomes.skipped.add(static_cast<double>(team.components_skipped));
  }
  return outcomes;
}

// Welch's t; with equal means beyond 4.5 in less than one of 10 000 comparisons of 40 teams.
void expect_same_mean(const Sample& a, const Sample& b, const char* what) {
  const double spread = std::sqrt(a.variance_of_mean() + b.variance_of_mean());
  EXPECT_LE(std::abs(a.mean() - b.mean()), 4.5 * spread + 1e-9) << what << ": " << a.mean() << " and " << b.mean();
}

void expect_same_study(const DomainText& text, std::size_t replicates) {
  std::vector<Rewriting> ways;
  for (const char* name : {"first", "second"}) {
    if (auto way = with_features_permuted(text, RandomStream{12}.split(text.name).split(name)))
      ways.push_back(*std::move(way));
  }
  for (auto& way : {mirrored(text), renamed(text), with_weights_scaled(text, 7e9)}) {
    if (way) ways.push_back(*way);
  }
  compare(text, ways, [&](const Atlas& original, const Atlas& other, const Rewriting& way) {
    if (has_equal_counters(original)) return;
    const auto a = study_of(original, replicates, 13), b = study_of(other, replicates, 13);
    if (way.same_vectors && way.same_states) {
      EXPECT_EQ(a.periods.sum, b.periods.sum);
      EXPECT_EQ(a.knowledge.sum, b.knowledge.sum);
    }
    expect_same_mean(a.periods, b.periods, "periods");
    expect_same_mean(a.knowledge, b.knowledge, "knowledge");
    expect_same_mean(a.skipped, b.skipped, "skipped components");
  });
}

TEST(Metamorphic, AStudyComesToTheSameHoweverTheRobotIsSaid) {
  for (const auto& text : known(false)) {
    if (text.name == "item-delivery") expect_same_study(text, 40);
  }
}

TEST(MetamorphicSlow, AStudyComesToTheSameHoweverTheRobotIsSaid) {
  for (const auto& text : known(false)) expect_same_study(text, 200);
}

}  // namespace
}  // namespace kith::laws
