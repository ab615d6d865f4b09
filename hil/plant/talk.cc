// Says one line to a run's control socket and prints the answer: jaywalk goto and its like for where a new process is
// dear, as it is in tools/rig/run's guest. usage: jaywalk_talk LINE ($JAYWALK_SOCKET names the socket)
#include <cstdio>
#include <exception>

#include "firmware/robot/control_socket.h"

int main(int argc, char** argv) {
  try {
    const std::string answer = jaywalk::ask(jaywalk::default_control_socket(), argc > 1 ? argv[1] : "status");
    std::fputs(answer.c_str(), stdout);
    return answer.starts_with("refused") ? 1 : 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "talk: %s\n", error.what());
    return 2;
  }
}
