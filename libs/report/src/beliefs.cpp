#include "sections.hpp"

#include <algorithm>
#include <cmath>

#include "kith/files/base64.hpp"
#include "kith/geometry/outline.hpp"
#include "kith/study/team_run.hpp"
#include "parameters.hpp"

namespace kith::detail {
namespace {

constexpr std::size_t kBytesPerParticle = 8;    // three 16-bit numbers in base64
constexpr std::size_t kMaxTeamBytes = 700'000;  // of base64 text
constexpr std::size_t kFewestParticles = 40;    // fewer do not show a shape
constexpr double kInteger16 = 32767.0;

// A belief at one time, as it is drawn.
struct Picture {
  double mass = 0.0;                 // in the policy's class
  std::vector<std::uint8_t> points;  // little endian, 16 bits a coordinate
};

// Keeps every belief of a team before teaching and after every period.
class Camera : public TeamObserver {
 public:
  Camera(const Atlas& atlas, std::size_t team_size, std::size_t particles, RandomStream random)
      : atlas_{atlas}, team_size_{team_size}, particles_{particles}, random_{random} {}

  void on_session(const Session& session, std::span<const std::size_t> members) override {
    members_.assign(members.begin(), members.end());
    const bool is_whole = members.size() == team_size_ && team_size_ > 1;
    const std::size_t slots = team_size_ + (is_whole ? session.belief().options().rules.size() : 0);
    if (frames_.empty()) frames_.emplace_back(slots, kUnknown);
  }
  void on_lesson(const Session& session, const Lesson&, const Learners& learners) override {
    fill_initial(session, learners);
  }
  void on_feedback(const Session& session, const Lesson& lesson, const std::vector<Learner::Response>&, const Feedback&,
                   const Learners& learners) override {
    frames_.push_back(frames_.back());
    for_each_belief(session, learners,
                    [&](std::size_t slot, const ParticleBelief& belief) { frames_.back()[slot] = take(belief, slot); });
    components_.push_back(lesson.component + 1);
  }
  void on_end(const Session& session, const Learners& learners) override { fill_initial(session, learners); }

  [[nodiscard]] std::size_t num_slots() const { return frames_.front().size(); }
  [[nodiscard]] const std::vector<std::size_t>& components() const { return components_; }
  [[nodiscard]] Json masses() const {
    Json result = Json::array();
    for (const auto& frame : frames_) {
      Json row = Json::array();
      for (const auto picture : frame) row.push_back(number(pictures_[picture].mass));
      result.push_back(std::move(row));
    }
    return result;
  }
  [[nodiscard]] std::string points() const {
    std::string all;
    for (const auto& frame : frames_) {
      for (const auto picture : frame) {
        all.insert(all.end(), pictures_[picture].points.begin(), pictures_[picture].points.end());
      }
    }
    return all;
  }

 private:
  static constexpr std::size_t kUnknown = static_cast<std::size_t>(-1);

  // The members of the session in its seats, then the team's beliefs.
  template <typename Action>
  void for_each_belief(const Session& session, const Learners& learners, Action action) {
    for (std::size_t i = 0; i < learners.size(); ++i) {
      if (const auto* own = learners[i]->belief()) action(members_[i] - 1, *own);
    }
    if (num_slots() == team_size_) return;
    const auto& rules = session.belief().options().rules;
    for (std::size_t k = 0; k < rules.size(); ++k) action(team_size_ + k, session.belief().aggregate(rules[k].name));
  }

  // What a belief was before its session holds for all frames before it.
  void fill_initial(const Session& session, const Learners& learners) {
    for_each_belief(session, learners, [&](std::size_t slot, const ParticleBelief& belief) {
      if (frames_.front()[slot] != kUnknown) return;
      const auto picture = take(belief, slot);
      for (auto& frame : frames_) frame[slot] = picture;
    });
  }

  std::size_t take(const ParticleBelief& belief, std::size_t slot) {
    Picture picture{belief.mass_in(atlas_.policy_bec_half_spaces()), {}};
    const auto random = random_.split(slot).split(frames_.size());
    for (const auto& draw : belief.systematic_draws(particles_, random)) {
      for (std::size_t copy = 0; copy < draw.count; ++copy) add_point(picture.points, belief.point(draw.index));
    }
    pictures_.push_back(std::move(picture));
    return pictures_.size() - 1;
  }

  static void add_point(std::vector<std::uint8_t>& bytes, const Direction& point) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      const auto value = static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(kInteger16 * point[k])));
      bytes.push_back(static_cast<std::uint8_t>(value & 0xFFu));
      bytes.push_back(static_cast<std::uint8_t>(value >> 8u));
    }
  }

  const Atlas& atlas_;
  std::size_t team_size_;
  std::size_t particles_;
  RandomStream random_;
  std::vector<std::size_t> members_;  // in the seats of the session, from 1
  std::vector<Picture> pictures_;
  std::vector<std::vector<std::size_t>> frames_;  // which picture, shape [frames, slots]
  std::vector<std::size_t> components_;
};

Json point_json(const Direction& point) {
  constexpr double kDigits = 1e6;
  Json result = Json::array();
  for (Eigen::Index k = 0; k < 3; ++k) result.push_back(std::round(point[k] * kDigits) / kDigits + 0.0);  // no -0
  return result;
}

void add_region(Json& regions, const std::string& label, std::vector<HalfSpace> half_spaces, const Cone& prior) {
  half_spaces.insert(half_spaces.end(), prior.facets().begin(), prior.facets().end());
  const auto cone = Cone::intersection(half_spaces);
  if (!cone) return;
  Json corners = Json::array();
  for (const auto& corner : outline(*cone)) corners.push_back(point_json(corner));
  // The last component has all constraints of the policy; one outline is enough.
  for (const auto& known : regions) {
    if (known.at("outline") == corners) return;
  }
  if (!corners.empty()) regions.push_back({{"label", label}, {"outline", std::move(corners)}});
}

Json regions_of(const Atlas& atlas) {
  Json regions = Json::array();
  add_region(regions, "policy (BEC)", atlas.policy_bec_half_spaces(), atlas.prior_cone());
  std::size_t number = 0;
  for (const auto& component : atlas.knowledge_components()) {
    add_region(regions, "component " + std::to_string(++number) + " (" + component.name + ")",
               atlas.constraints().half_spaces(component.constraints), atlas.prior_cone());
  }
  add_region(regions, "prior", {}, atlas.prior_cone());
  return regions;
}

Json belief_names(const RunFiles& run, const std::string& composition, std::size_t slots) {
  Json names = Json::array();
  for (std::size_t i = 0; i < composition.size(); ++i) {
    const auto& label = learner_type(run.spec(), composition[i]).label;
    const auto type = label.empty() ? std::string{composition[i]} : label;
    names.push_back({{"name", "member " + std::to_string(i + 1) + " (" + type + ")"}, {"kind", "own"}});
  }
  if (slots > composition.size()) {
    for (const auto& rule : run.spec().teaching.rules) {
      const std::string name{rule.name};
      names.push_back({{"name", "teacher: " + name + " belief"}, {"kind", name}});
    }
  }
  return names;
}

// Whether the team came out as its row says.
bool agrees(const TeamRecord& record, const TeamRecord& row) {
  constexpr double kTolerance = 1e-12;  // the tables hold the exact number, but it may have been written elsewhere
  return record.periods == row.periods && record.completed() == row.completed() &&
         std::abs(record.knowledge - row.knowledge) <= kTolerance;
}

}  // namespace

std::optional<Json> belief_spheres(const RunFiles& run, const ReportDesign& design, const RunData& data,
                                   const Atlas& atlas, std::size_t particles, std::vector<std::string>& notes) {
  if (run.domain.num_features() != 3) {
    notes.push_back("Beliefs are drawn for three features; this domain has " +
                    std::to_string(run.domain.num_features()) + ".");
    return std::nullopt;
  }
  Json teams = Json::array();
  TeachingCache cache{atlas};
  for (const auto& [team, why] : telling_teams(design, data)) {
    const auto& address = run.teams[team];
    const auto& series = design.series[design.cells[design.cell_of_team[team]].series];
    const auto size = address.composition.size();
    const auto pictures = (data.teams[team].periods + 1) * (size + 2);
    const auto count = std::min(particles, kMaxTeamBytes / (kBytesPerParticle * pictures));
    if (count < std::min(particles, kFewestParticles)) {
      notes.push_back("The beliefs of team " + std::to_string(address.team) +
                      " are left out: " + std::to_string(data.teams[team].periods) + " periods are too many to draw.");
      continue;
    }
    const auto& spec = run.study.variants[address.variant];
    const auto has_belief = [&](char letter) { return num_particles(learner_type(spec, letter).parameters) > 0; };
    if (!std::all_of(address.composition.begin(), address.composition.end(), has_belief)) {
      notes.push_back("The beliefs of team " + std::to_string(address.team) +
                      " are left out: not all of its members have a particle belief.");
      continue;
    }
    Camera camera{atlas, size, count, RandomStream{spec.seed}.split("report").split(address.team)};
    if (!agrees(run_team(atlas, cache, spec, address, &camera), data.teams[team])) {
      notes.push_back("The belief spheres are left out: team " + std::to_string(address.team) +
                      ", rerun from the frozen inputs, does not match tables/teams.csv. The tables were "
                      "changed, or made by another version of kith.");
      return std::nullopt;
    }
    const auto slots = camera.num_slots();
    teams.push_back({{"title", "Team " + std::to_string(address.team) + ": " + series.code + ", " +
                                   address.composition + ", replicate " + std::to_string(address.replicate)},
                     {"team", address.team},
                     {"why", why},
                     {"strategy", series.code},
                     {"composition", address.composition},
                     {"periods", camera.components().size()},
                     {"components", camera.components()},
                     {"beliefs", belief_names(run, address.composition, slots)},
                     {"mass", camera.masses()},
                     {"particles", {{"bits", 16}, {"count", count}, {"data", base64(camera.points())}}}});
  }
  if (teams.empty()) return std::nullopt;
  return Json{{"features", run.domain.feature_names()},
              {"truth", point_json(run.domain.weights().unit)},
              {"regions", regions_of(atlas)},
              {"teams", std::move(teams)}};
}

}  // namespace kith::detail
