#include "kith/study/team_streams.hpp"

#include "kith/core/distributions.hpp"
#include "kith/teaching/known_components.hpp"

namespace kith {

RandomStream team_stream(const StudySpec& spec, const TeamAddress& address) {
  RandomStream root{spec.seed};
  if (spec.pairing == Pairing::kNone) root = root.split(address.strategy);
  return root.split(address.composition).split(address.replicate);
}

std::string readable_address(const StudySpec& spec, const TeamAddress& address) {
  std::string text = std::to_string(spec.seed) + "/";
  if (spec.pairing == Pairing::kNone) text += address.strategy + "/";
  return text + address.composition + "/" + std::to_string(address.replicate);
}

RandomStream person_stream(const RandomStream& team, std::size_t member) { return team.split("person").split(member); }

RandomStream belief_stream(const RandomStream& person) { return person.split("teacher belief"); }

RandomStream teacher_stream(const RandomStream& team) { return team.split("teacher"); }

RandomStream lone_teacher_stream(const RandomStream& person) { return person.split("alone"); }

const LearnerType& type_of_person(const StudySpec& spec, char letter, const RandomStream& person) {
  const auto& type = learner_type(spec, letter);
  if (type.mixture.empty()) return type;
  std::vector<double> shares;
  for (const auto& part : type.mixture) shares.push_back(part.share);
  auto random = person.split("type");
  return learner_type(spec, type.mixture[categorical(shares, random)].letter);
}

std::vector<double> draw_traits(const LearnerType& type, const RandomStream& person) {
  return type.model->draw(type.parameters, person.split("parameters"));
}

std::unique_ptr<Learner> make_learner(const StudySpec& spec, const LearnerType& type, const std::vector<double>& traits,
                                      const RandomStream& person, TeachingCache& cache) {
  const auto& atlas = cache.atlas();
  const auto prior = prior_of(type, atlas.prior_cone());
  const auto known = known_to(type, atlas.prior_cone());
  const LearnerStart start{
      .cover = [&](std::size_t num_points) -> const PriorCover& { return cache.cover(prior, num_points, known); },
      .likelihood = spec.teaching.likelihood,
      .components = [&] { return constraints_of_components(atlas); },
      .records_support = spec.beliefs};
  return type.model->make(type.parameters, traits, start, person.split("learner"));
}

}  // namespace kith
