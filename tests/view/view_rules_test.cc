// What clients may have, and how much.
#include <vector>

#include "apps/view/view_client.h"
#include "tests/support/catch.h"

using namespace jaywalk::view;
using namespace std::chrono_literals;

namespace {

const ViewRules kRun{.token = "abc"};
const ViewRules kNetwork{.token = "abc", .loopback = false};
const ViewRules kSimulation{};

ViewRequest request(const char* method, const char* target, bool is_local = true) {
  return {.method = method, .target = target, .host = "127.0.0.1:80", .is_local = is_local, .is_encrypted = !is_local};
}

ViewRequest socket(const char* target, const char* origin = "") {
  ViewRequest asked = request("GET", target);
  asked.origin = origin;
  asked.is_upgrade = true;
  return asked;
}

Placed placed(std::uint32_t address, int age_s, std::chrono::milliseconds stuck = 0ms) {
  return {.address = address, .since = Placed::Clock::time_point{1h} - std::chrono::seconds(age_s), .stuck = stuck};
}

}  // namespace

TEST_CASE("a run wants its token for the page and any WebSocket, on 127.0.0.1 too") {
  CHECK(judge(request("GET", "/"), kRun).status == 403);
  CHECK(judge(request("GET", "/?token=abd"), kRun).status == 403);
  CHECK(judge(request("GET", "/?token=abcd"), kRun).status == 403);
  CHECK(judge(request("GET", "/?a=1&token=abc"), kRun).service == Service::kPage);
  CHECK(judge(socket("/ws"), kRun).status == 403);
  CHECK(judge(socket("/ws?token=abc"), kRun).service == Service::kSocket);
  CHECK(judge(socket("/ws"), kSimulation).service == Service::kSocket);
}

TEST_CASE("a stop is a POST and wants no token from this machine, from others it does") {
  CHECK(judge(request("POST", "/stop"), kRun).service == Service::kStop);
  CHECK(judge(request("GET", "/stop"), kRun).status == 405);
  CHECK(judge(request("POST", "/stop", false), kNetwork).status == 403);
  CHECK(judge(request("POST", "/stop?token=abc", false), kNetwork).service == Service::kStop);
  ViewRequest anywhere = request("POST", "/stop");
  anywhere.host = "evil.example";  // a page of another site may stop the robot
  CHECK(judge(anywhere, kRun).service == Service::kStop);
}

TEST_CASE("a page of another site opens no WebSocket, whatever name it gives this machine") {
  CHECK(judge(socket("/ws?token=abc", "http://evil.example"), kRun).status == 403);
  CHECK(judge(socket("/ws?token=abc", "http://127.0.0.1:80"), kRun).service == Service::kSocket);
  CHECK(judge(socket("/ws?token=abc", "https://127.0.0.1:80"), kRun).status == 403);
  ViewRequest renamed = socket("/ws?token=abc", "http://evil.example");
  renamed.host = "evil.example";
  CHECK(judge(renamed, kRun).status == 403);
  CHECK(judge(socket("/ws", "https://tools.example"), {.origin = "https://tools.example"}).service == Service::kSocket);
}

TEST_CASE("a desktop program, whose pages are of no site, opens a WebSocket with the token and never without one") {
  for (const char* origin : {"null", "file://", "file:///opt/Foxglove/index.html"}) {
    CHECK(judge(socket("/ws?token=abc", origin), kRun).service == Service::kSocket);
    CHECK(judge(socket("/ws", origin), kRun).status == 403);
    CHECK(judge(socket("/ws?token=abd", origin), kRun).status == 403);
    CHECK(judge(socket("/ws", origin), {}).status == 403);
  }
  CHECK(judge(socket("/ws?token=abc", "file.example"), kRun).status == 403);
}

TEST_CASE("another machine must come by TLS, with the token") {
  ViewRequest plain = request("GET", "/?token=abc", false);
  plain.is_encrypted = false;
  CHECK(judge(plain, kNetwork).status == 403);
  CHECK(judge(request("GET", "/?token=abc", false), kNetwork).service == Service::kPage);
  CHECK(judge(request("GET", "/", false), kNetwork).status == 403);
}

TEST_CASE("Foxglove's WebSocket has any path, and nothing else is served") {
  ViewRequest foxglove = socket("/any?token=abc");
  foxglove.subprotocols = "a, foxglove.websocket.v1 ,b";
  CHECK(judge(foxglove, kRun).subprotocol == "foxglove.websocket.v1");
  foxglove.subprotocols = "foxglove.websocket.v2";
  CHECK(judge(foxglove, kRun).status == 404);
  CHECK(judge(request("GET", "/etc/passwd?token=abc"), kRun).status == 404);
  CHECK(judge(request("DELETE", "/?token=abc"), kRun).status == 405);
}

TEST_CASE("an outbox holds its budget and one message at most") {
  Outbox outbox;
  const auto body = std::make_shared<const std::string>(100'000, 'x');
  int taken = 0;
  for (int k = 0; k < 1000; ++k) taken += outbox.add({"", body}) ? 1 : 0;
  CHECK(taken == 6);  // 512 KiB
  CHECK(outbox.bytes() < Outbox::kMostBytes + 101'000);
  outbox.pop();
  CHECK(outbox.add({"", body}));
  const auto nothing = std::make_shared<const std::string>();
  Outbox small;
  for (taken = 0; small.add({"", nothing}); ++taken) {
  }
  CHECK(taken <= 512 * 1024 / 32);
}

TEST_CASE("of half requests the address that has most loses its oldest, never the newcomer") {
  const std::vector<Placed> flood{placed(7, 1), placed(9, 5), placed(7, 3), placed(7, 2)};
  CHECK(gives_way(flood, Stage::kAsks, 9) == 2U);
  CHECK(gives_way(flood, Stage::kAsks, 7) == 2U);
  std::vector<Placed> answered{placed(7, 1), placed(7, 2), placed(9, 1)};
  answered[2].is_served = true;
  CHECK(gives_way(answered, Stage::kIsAnswered, 4) == 2U);
  const std::vector<Placed> many{placed(1, 1), placed(2, 3), placed(3, 2)};
  CHECK(gives_way(many, Stage::kAsks, 4) == 1U);
}

TEST_CASE("those who look keep their places, but for one that is stuck or whose address has many") {
  const std::vector<Placed> all_well{placed(1, 9), placed(2, 8), placed(3, 7, 900ms)};
  CHECK_FALSE(gives_way(all_well, Stage::kLooks, 4));
  const std::vector<Placed> stuck{placed(1, 9), placed(2, 8, 1500ms), placed(3, 7, 1200ms)};
  CHECK(gives_way(stuck, Stage::kLooks, 4) == 1U);
  const std::vector<Placed> greedy{placed(1, 9), placed(2, 8), placed(2, 7)};
  CHECK(gives_way(greedy, Stage::kLooks, 4) == 1U);
  CHECK_FALSE(gives_way(greedy, Stage::kLooks, 2));
}
