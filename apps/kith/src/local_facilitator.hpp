#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "kith/explain/json.hpp"
#include "kith/service/live_service.hpp"

namespace kith::cli {

/// A facilitator inside of the program: what `kith serve` itself asks of the service before people come.
class LocalFacilitator {
 public:
  /// @param service  outlives it. @param token  of a facilitator.
  LocalFacilitator(LiveService& service, const std::string& token);
  ~LocalFacilitator();
  LocalFacilitator(const LocalFacilitator&) = delete;
  LocalFacilitator& operator=(const LocalFacilitator&) = delete;

  /// The facilitator's view, as soon as it is as wanted. @throws kith::Error (kIo) if that takes too long.
  [[nodiscard]] Json view(const std::function<bool(const Json&)>& wanted = {});
  /// Sends a message and waits until it is acknowledged. @throws kith::Error (kInfeasible) with the reason if it is
  /// refused; kIo.
  void ask(const std::string& type, Json body);
  /// Makes rooms until there are `count`. @param seats  "person" or a letter for each; none: as the study says.
  void make_rooms(std::size_t count, const std::vector<std::string>& seats = {});

 private:
  struct Ear;
  LiveService& service_;
  std::shared_ptr<Ear> ear_;
  LiveService::ConnectionId connection_;
  std::size_t next_id_ = 0;
};

}  // namespace kith::cli
