#include "kith/hosting/live_service.hpp"
