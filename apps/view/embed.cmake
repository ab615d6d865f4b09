# Writes OUT, a C++ file that holds the bytes of IN: cmake -D IN=... -D OUT=... -P embed.cmake
file(READ "${IN}" bytes HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${bytes}")
file(WRITE "${OUT}" "#include \"apps/view/live_page.h\"\n\nnamespace jaywalk::view {\nnamespace {\nconstexpr char kPage[] = {${bytes}};\n}\n"
  "std::string_view live_page() noexcept { return {kPage, sizeof kPage}; }\n}  // namespace jaywalk::view\n")
