#include "random_domains.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <stdexcept>

#include "kith/core/distributions.hpp"

namespace kith::laws {
namespace {

std::string decimal(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

// A number of quarters in [low, high].
double quarters(double low, double high, RandomStream& random) {
  const auto n = static_cast<std::size_t>((high - low) * 4.0) + 1;
  return low + 0.25 * static_cast<double>(uniform_index(n, random));
}

struct Feature {
  std::string name, when;
  double weight;
};

// Features in any order, weights and the prior that steps cost.
std::string reward_text(std::vector<Feature> features, RandomStream& random) {
  for (std::size_t i = features.size(); i > 1; --i) std::swap(features[i - 1], features[uniform_index(i, random)]);
  std::string text, weights;
  for (const auto& feature : features) {
    text += "[[feature]]\nname = \"" + feature.name + "\"\n";
    if (!feature.when.empty()) text += "when = \"" + feature.when + "\"\n";
    weights += (weights.empty() ? "" : ", ") + feature.name + " = " + decimal(feature.weight);
  }
  return text + "[reward]\nweights = { " + weights + " }\n[prior]\nhalfspaces = [ { step = -1 } ]\n";
}

DomainText drawn_map(RandomStream& random) {
  const auto width = 3 + uniform_index(3, random), height = 2 + uniform_index(3, random);
  const auto kinds = 1 + uniform_index(3, random);
  std::vector<std::string> rows(height, std::string(width, '.'));
  for (auto& row : rows) {
    for (auto& cell : row) {
      const double u = uniform01(random);
      if (u < 0.12) cell = '#';
      if (u > 0.55) cell = static_cast<char>('a' + uniform_index(kinds, random));
    }
  }
  const auto put = [&](char symbol) {
    for (;;) {
      auto& cell = rows[uniform_index(height, random)][uniform_index(width, random)];
      if (cell == 'S' || cell == 'G' || cell == 'B') continue;
      cell = symbol;
      return;
    }
  };
  const bool is_delivery = uniform01(random) < 0.3, has_charger = uniform01(random) < 0.5;
  for (const char symbol : std::string{"SG"} + (has_charger ? "B" : "")) put(symbol);
  std::string text = "schema = \"kith.domain/1\"\nid = \"random-map\"\n[map]\nrows = [";
  for (const auto& row : rows) text += "\"" + row + "\", ";
  text += "]\n[map.legend]\n\"#\" = \"wall\"\n\".\" = \"floor\"\n";
  text += is_delivery ? "S = { start = true, item = \"parcel\" }\nG = { destination = \"parcel\" }\n"
                      : "S = { start = true }\nG = { goal = true }\n";
  std::vector<Feature> features{{"step", "action", -quarters(0.5, 2.0, random)}};
  for (std::size_t k = 0; k < kinds; ++k) {
    const std::string symbol(1, static_cast<char>('a' + k)), name = "terrain-" + symbol;
    const bool is_optional = uniform01(random) < 0.8;
    text += symbol + " = { terrain = \"" + name + "\"" +
            (is_optional ? std::string{", optional = \"group-"} + symbol + "\"" : "") + " }\n";
    features.push_back({name, (uniform01(random) < 0.5 ? "leave:" : "enter:") + name, -quarters(0.25, 5.0, random)});
  }
  if (has_charger) {
    text += "B = { station = \"charger\", optional = true }\n";
    features.push_back({"charge", "leave:charger", quarters(0.5, 4.0, random)});
  }
  return domain_text("random-map", text + reward_text(std::move(features), random));
}

DomainText drawn_model(RandomStream& random, double slip, double discount) {
  const auto n = 4 + uniform_index(4, random), actions = 2 + uniform_index(2, random);
  const auto d = 2 + uniform_index(3, random), mdps = 1 + uniform_index(2, random);
  std::string states = "state,terminal,start\n", transitions = "mdp,state,action,next,probability";
  std::vector<Feature> features{{"step", "", -quarters(0.5, 2.0, random)}};
  for (std::size_t k = 1; k < d; ++k) features.push_back({"f" + std::to_string(k), "", -quarters(0.25, 4.0, random)});
  for (const auto& feature : features) transitions += "," + feature.name;
  transitions += "\n";
  for (std::size_t s = 0; s < n; ++s) states += "s" + std::to_string(s) + ",false,true\n";
  states += "end,true,false\n";
  const auto name = [&](std::size_t s) { return s == n ? std::string{"end"} : "s" + std::to_string(s); };
  for (std::size_t m = 0; m < mdps; ++m) {
    for (std::size_t s = 0; s < n; ++s) {
      for (std::size_t a = 0; a < actions; ++a) {
        // The first action leads on, and every slip as well, so that every MDP ends however often it slips.
        const auto ahead = [&] { return s + 1 + uniform_index(n - s, random); };
        const auto next = a == 0 ? ahead() : (s + 1 + uniform_index(n, random)) % (n + 1);
        const auto other = ahead();
        const auto row = [&](std::size_t to, double probability) {
          std::string line = "world" + std::to_string(m) + "," + name(s) + ",a" + std::to_string(a) + "," + name(to) +
                             "," + decimal(probability) + ",1";
          for (std::size_t k = 1; k < d; ++k) line += "," + std::to_string(uniform_index(3, random));
          return line + "\n";
        };
        const auto main = row(next, next == other ? 1.0 : 1.0 - slip), slipped = row(other, slip);
        if (slip < 1.0 || next == other) transitions += main;
        if (slip > 0.0 && next != other) transitions += slipped;
      }
    }
  }
  const auto text = "schema = \"kith.domain/1\"\nid = \"random-model\"\n[mdp]\ndiscount = " + decimal(discount) +
                    "\n[model]\nformat = \"csv\"\nstates = \"states.csv\"\ntransitions = \"transitions.csv\"\n" +
                    reward_text(std::move(features), random);
  return domain_text("random-model", text, {{"states.csv", states}, {"transitions.csv", transitions}});
}

// The first draw that is sound.
DomainText first_sound(RandomStream random, const std::function<DomainText(RandomStream&)>& draw) {
  for (std::uint64_t i = 0; i < 1000; ++i) {
    auto stream = random.split(i);
    auto text = draw(stream);
    if (text.read().domain) return text;
  }
  throw std::logic_error{"no random domain is sound"};
}

}  // namespace

DomainText robot_that_never_ends() {
  return domain_text("robot-that-never-ends", R"(schema = "kith.domain/1"
id = "robot-that-never-ends"
[mdp]
discount = 0.8
[map]
rows = ["..r.G",
        "S.rr.",
        "B.r.."]
[map.legend]
"." = "floor"
"r" = { terrain = "rubble", optional = "rubble" }
"B" = { station = "charger", optional = true }
"S" = { start = true }
"G" = { goal = true }
[[feature]]
name = "rubble"
when = "leave:rubble"
[[feature]]
name = "recharge"
when = "leave:charger"
[[feature]]
name = "step"
when = "action"
[reward]
weights = { rubble = -8, recharge = 3.5, step = -1 }
[prior]
halfspaces = [ { step = -1 } ]
)");
}

DomainText random_map(RandomStream random) { return first_sound(random, drawn_map); }

DomainText random_model(RandomStream random, double slip, double discount) {
  return first_sound(random, [&](RandomStream& stream) { return drawn_model(stream, slip, discount); });
}

}  // namespace kith::laws
