#include "built_in.hpp"

#include "kith/domains/domain_file.hpp"

namespace kith {

const std::vector<BuiltInDomain>& built_in_domains() {
  static const std::vector<BuiltInDomain> kDomains{
      {"item-delivery", "a robot brings a parcel home past rubble and a charger (64 MDPs)", detail::kItemDeliveryText},
  };
  return kDomains;
}

}  // namespace kith
