// What lessons of stochastic and large domains say is true: sentences drawn at random, read back from their words and
// tried on random weights.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <set>

#include "atlases.hpp"
#include "kith/explain/curriculum.hpp"
#include "kith/geometry/cone_sampler.hpp"
#include "lake.hpp"
#include "sentences.hpp"

namespace kith {
namespace {

using testing::atlas_of;
using testing::ReadSentence;
using Constraints = std::vector<HalfSpace>;

// A sentence of a lesson, the constraint that it states, and what is conveyed with it.
struct Said {
  std::string domain, text;
  HalfSpace constraint;
  Constraints together;
};

void add(std::vector<Said>& all, const std::string& name, const Constraints& constraints) {
  for (const auto& constraint : constraints) {
    const auto text = in_words(atlas_of(name).domain(), constraint, constraints);
    if (!text.empty()) all.push_back({name, text, constraint, constraints});
  }
}

// Every sentence of a lesson, once.
std::vector<Said> sentences_of(const std::string& name) {
  std::vector<Said> all;
  for (const auto& component : make_curriculum(atlas_of(name)).components) {
    add(all, name, component.constraints);
    for (const auto& shown : component.demonstrations) add(all, name, shown.conveys);
    for (const auto& test : component.tests) add(all, name, test.covers);
  }
  std::set<std::string> known;
  std::erase_if(all, [&](const Said& said) { return !known.insert(said.text).second; });
  return all;
}

std::vector<Said> drawn(const std::vector<std::string>& domains, std::size_t n) {
  std::vector<Said> all;
  for (const auto& name : domains) {
    const auto some = sentences_of(name);
    all.insert(all.end(), some.begin(), some.end());
  }
  RandomStream random{60};
  for (std::size_t i = 0; i + 1 < all.size(); ++i) std::swap(all[i], all[i + uniform_index(all.size() - i, random)]);
  if (all.size() > n) all.resize(n, all.front());
  return all;
}

double value(const IntegerVector& coefficients, const Direction& w) {
  double sum = 0.0;
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    sum += static_cast<double>(coefficients[k]) * w[static_cast<Eigen::Index>(k)];
  }
  return sum;
}

// How many of n weights in a region, among those that fulfil the condition, refute the sentence.
std::size_t refuted(const ReadSentence& sentence, const Constraints& region, std::size_t n, RandomStream random) {
  constexpr double kRounding = 1e-9;
  Cone cone{sentence.said().size()};
  auto all = region;
  if (sentence.condition()) all.emplace_back(*sentence.condition());
  if (!cone.clip(all)) return 0;
  const ConeSampler sampler{cone};
  std::size_t count = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (value(sentence.said(), sampler.sample(random)) < -kRounding) ++count;
  }
  return count;
}

Constraints with_prior(const Domain& domain, Constraints more) {
  more.insert(more.end(), domain.prior().begin(), domain.prior().end());
  return more;
}

// Holds wherever its constraint holds (or, where that is not enough, all that is conveyed with it), and not elsewhere.
void expect_true(const Said& said, std::size_t n) {
  SCOPED_TRACE(said.domain + ": " + said.text);
  const auto& domain = atlas_of(said.domain).domain();
  const ReadSentence sentence{domain, said.text};
  ASSERT_TRUE(sentence.is_understood());
  const RandomStream random{11};
  if (refuted(sentence, with_prior(domain, {said.constraint}), n, random.split("inside")) > 0) {
    EXPECT_FALSE(domain.is_exact());
    EXPECT_EQ(refuted(sentence, with_prior(domain, said.together), n, random.split("together")), 0u);
  }
  EXPECT_GT(refuted(sentence, with_prior(domain, {said.constraint.opposite()}), n, random.split("outside")), 0u);
}

// If KITH_SENTENCES names a file they are written to it, for reading.
void write(const std::vector<Said>& sentences) {
  const char* const file = std::getenv("KITH_SENTENCES");
  if (file == nullptr) return;
  std::ofstream out{file};
  for (const auto& said : sentences) {
    out << atlas_of(said.domain).domain().id() << " " << normal_text(atlas_of(said.domain).domain(), said.constraint)
        << ": " << said.text << "\n";
  }
}

std::vector<std::string> stochastic_domains() {
  const std::string source = KITH_SOURCE_DIR;
  return {source + "/domains/icy_crossing.toml", source + "/docs/examples/cliff.toml",
          testing::slippery_lake("steps", "{ step = -1 }", "1.0"),
          testing::slippery_lake("signs", "{ step = -1 }, { hole = -1 }, { goal = 1 }", "0.99")};
}

TEST(Sentences, OfStochasticLessonsAreTrue) {
  const auto sentences = drawn(stochastic_domains(), 15);
  EXPECT_EQ(sentences.size(), 15u);
  for (const auto& said : sentences) expect_true(said, 500);
}

TEST(SentencesSlow, OfAllStochasticAndLargeLessonsAreTrue) {
  auto domains = stochastic_domains();
  domains.insert(domains.end(), {"navigation", "rescue-floor"});
  const auto sentences = drawn(domains, 60);
  EXPECT_EQ(sentences.size(), 60u);
  for (const auto& said : sentences) expect_true(said, 10'000);
  write(sentences);
}

TEST(Sentences, SayWhatAConstraintSaysWhateverItIs) {
  constexpr std::array<std::int64_t, 5> kFew{-2, -1, 0, 1, 2};
  for (const std::string name : {"item-delivery", "two-goals", "cookie-crumb"}) {
    const auto domain = load_domain(name);
    for (const auto x : kFew) {
      for (const auto y : kFew) {
        for (const auto z : kFew) {
          const IntegerVector normal{x, y, z};
          if (normal.is_zero()) continue;
          const auto text = in_words(domain, HalfSpace{normal});
          SCOPED_TRACE(name + ": " + text);
          const ReadSentence sentence{domain, text};
          ASSERT_TRUE(sentence.is_understood());
          EXPECT_EQ(HalfSpace{sentence.said()}, HalfSpace{normal});
        }
      }
    }
  }
}

TEST(ReadSentence, UnderstandsWhatSentencesMean) {
  const auto& domain = atlas_of("item-delivery").domain();  // rubble, recharge, step
  const auto said = [&](const std::string& text) { return ReadSentence{domain, text}.said(); };
  EXPECT_EQ(said("crossing rubble costs more than 2 steps"), (IntegerVector{-1, 0, 2}));
  EXPECT_EQ(said("stopping at the charger is worth less than 4 steps"), (IntegerVector{0, -1, -4}));
  EXPECT_EQ(said("stopping at the charger is worth more than 2 steps"), (IntegerVector{0, 1, 2}));
  EXPECT_EQ(said("crossing rubble twice costs less than 5 steps plus what stopping at the charger is worth"),
            (IntegerVector{2, 1, -5}));
  EXPECT_EQ(said("stopping at the charger is better than crossing rubble"), (IntegerVector{-1, 1, 0}));
  EXPECT_EQ(said("stopping at the charger and 3 fewer steps are worth more than not crossing rubble twice"),
            (IntegerVector{2, 1, -3}));
  const ReadSentence conditional{domain, "if stopping at the charger is worth something, 3 steps cost something"};
  EXPECT_TRUE(conditional.is_understood());
  EXPECT_EQ(conditional.condition(), (IntegerVector{0, 1, 0}));
  EXPECT_FALSE((ReadSentence{domain, "crossing rubble costs a lot"}).is_understood());
}

}  // namespace
}  // namespace kith
