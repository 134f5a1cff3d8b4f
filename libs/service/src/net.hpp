#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/system/error_code.hpp>

namespace kith {

namespace asio = boost::asio;
using asio::ip::tcp;
using NetError = boost::system::error_code;

}  // namespace kith
