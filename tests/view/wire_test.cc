// The wire between live page and program: handshake, frames, orders. Vectors are those of RFC 6455 and RFC 4648.
#include <cmath>
#include <string>

#include "firmware/view/http.h"
#include "firmware/view/view_orders.h"
#include "firmware/view/view_scene.h"
#include "firmware/view/websocket.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::view;
using namespace std::string_literals;

TEST_CASE("the handshake's key is answered as in RFC 6455 section 1.3") {
  CHECK(accept_key("dGhlIHNhbXBsZSBub25jZQ==") == "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
}

TEST_CASE("base64 pads as in RFC 4648 section 10") {
  CHECK(base64("").empty());
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("foob") == "Zm9vYg==");
}

TEST_CASE("a server's frame is that of RFC 6455 section 5.7") {
  CHECK(to_frame(Opcode::kText, "Hello") == std::string("\x81\x05Hello"));
  CHECK(to_frame(Opcode::kText, std::string(256, 'x')).substr(0, 4) == std::string("\x81\x7E\x01\x00", 4));
  CHECK(to_frame(Opcode::kText, std::string(65536, 'x')).substr(0, 10) ==
        std::string("\x81\x7F\0\0\0\0\0\x01\0\0", 10));
}

TEST_CASE("a masked frame is taken when it is whole and leaves what follows") {
  const std::string hello = "\x81\x85\x37\xfa\x21\x3d\x7f\x9f\x4d\x51\x58";  // RFC 6455 section 5.7
  ClientFrame frame;
  for (std::size_t cut = 0; cut < hello.size(); ++cut) {
    std::string part = hello.substr(0, cut);
    CHECK(take_frame(part, frame) == FrameState::kIncomplete);
  }
  std::string received = hello + "more";
  REQUIRE(take_frame(received, frame) == FrameState::kWhole);
  CHECK(frame.payload == "Hello");
  CHECK(received == "more");
}

TEST_CASE("frames without a mask, in fragments or too long are refused") {
  ClientFrame frame;
  for (std::string bad : {std::string("\x81\x05Hello"), std::string("\x01\x85\x37\xfa\x21\x3d\x7f\x9f\x4d\x51\x58"),
                          std::string("\x81\xFE\xFF\xFF", 4), std::string("\x81\xFF\0\0", 4)}) {
    CHECK(take_frame(bad, frame) == FrameState::kRefused);
  }
}

TEST_CASE("a request tells path, query and headers") {
  const auto request = parse_request("GET /ws?a=1&token=abc HTTP/1.1\r\nHost: 127.0.0.1:80\r\nX-Y:  z \r\n\r\n");
  REQUIRE(request);
  CHECK(request->path == "/ws");
  CHECK(query_value(request->query, "token") == "abc");
  CHECK(query_value(request->query, "tok").empty());
  CHECK(request->header("x-y") == "z");
  CHECK_FALSE(parse_request("rubbish\r\n\r\n"));
  CHECK_FALSE(parse_request("\r\n\r\n"));
}

TEST_CASE("orders are a goal with or without a heading, stop, pause or step") {
  const auto goal = parse_order(R"({"goal":[1.5,-2,0.5]})");
  REQUIRE(goal);
  CHECK(goal->goal->goal_in_map == Vec2{1.5, -2.0});
  CHECK(goal->goal->heading_rad == 0.5);
  CHECK(std::isnan(parse_order(R"({"goal":[1,2]})")->goal->heading_rad));
  CHECK(parse_order(R"({"stop":true})")->stop);
  CHECK(parse_order(R"({"pause":false})")->pause == false);
  CHECK(parse_order(R"({"step":true})")->step);
}

TEST_CASE("what is no order is left out") {
  for (const char* text :
       {"", "{", "[]", "{}", R"({"goal":[1]})", R"({"goal":[1e300,0]})", R"({"goal":[0,0,180]})", R"({"goal":["a",1]})",
        R"({"goal":1})", R"({"stop":1})", R"({"stop":false})", R"({"jump":true})", R"({"stop":true,"goal":[1,2]})"}) {
    INFO(text);
    CHECK_FALSE(parse_order(text));
  }
}

TEST_CASE("a stop takes back a goal that waits, and a goal a stop") {
  ViewOrders orders;
  orders.add(*parse_order(R"({"goal":[1,2]})"));
  orders.add(*parse_order(R"({"stop":true})"));
  const ViewOrder stopped = orders.take();
  CHECK(stopped.stop);
  CHECK_FALSE(stopped.goal);
  CHECK_FALSE(orders.take().stop);
  orders.add(*parse_order(R"({"stop":true})"));
  orders.add(*parse_order(R"({"goal":[1,2]})"));
  CHECK_FALSE(orders.take().stop);
}

TEST_CASE("the field's bytes are its potential in 253 steps, with codes for no way and not free") {
  const float nan = std::nanf(""), inf = HUGE_VALF;
  const float psi[] = {0.0F, 1.0F, nan, inf};  // the farthest is 1: byte 253
  const FieldView field{.low = {10, 20}, .width = 2, .height = 2, .cell_m = 0.1, .psi = psi};
  CHECK(to_json(field) ==
        R"({"kind":"field","x":1.0,"y":2.0,"cell_m":0.1,"width":2,"cells":")" + base64("\x00\xFD\xFF\xFE"s) + "\"}");
}
