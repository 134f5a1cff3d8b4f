#include "kith/study/audit_people.hpp"

#include <utility>

#include "kith/study/observed_team.hpp"
#include "kith/teaching/kind_of_person.hpp"

namespace kith {

AuditOptions audit_options(const TeachingOptions& teaching, double forgetting) {
  AuditOptions options;
  options.bank.filter = teaching.filter;
  options.bank.likelihood = teaching.likelihood;
  options.bank.known = teaching.known;
  options.forgetting = forgetting;
  return options;
}

std::vector<AuditedPerson> audit_people(TeachingCache& cache, const TeachingOptions& teaching, double forgetting,
                                        std::vector<ObservedPerson> group) {
  if (group.empty()) return {};
  const auto& first = group.front().person;
  const auto random = RandomStream{1}.split("audit").split(first.team).split(first.room);
  std::vector<AuditedPerson> people;
  std::vector<std::vector<ObservedPeriod>> periods;
  for (auto& [person, seen] : group) {
    if (teaching.hypotheses_about == HypothesesAbout::kKinds) {
      person.kinds = kinds_after(cache, teaching, seen, random.split("kinds").split(people.size()));
    }
    people.push_back(std::move(person));
    periods.push_back(std::move(seen));
  }

  auto audits = Auditor{cache, audit_options(teaching, forgetting)}.audit_group(periods, random);
  for (std::size_t i = 0; i < people.size(); ++i) people[i].audit = std::move(audits[i]);
  return people;
}

std::vector<AuditedPerson> audit_team(TeachingCache& cache, const Study& study, const TeamRecord& record,
                                      double forgetting) {
  const auto& address = record.address;
  std::vector<ObservedPerson> group;
  for (auto& periods : observed_people(cache.atlas(), record)) {
    AuditedPerson person;
    person.team = address.team;
    person.group = describe_team(study, address);
    person.member = group.size() + 1;
    person.type = address.composition[group.size()];
    group.push_back({std::move(person), std::move(periods)});
  }
  return audit_people(cache, study.variants[address.variant].teaching, forgetting, std::move(group));
}

}  // namespace kith
