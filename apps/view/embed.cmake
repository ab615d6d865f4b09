# Writes OUT, a C++ file that holds the live page: page.html in DIR with its style sheet and scripts put in.
# cmake -D DIR=... -D SCRIPTS=a.js,b.js -D OUT=... -P embed.cmake
string(REPLACE "," ";" SCRIPTS "${SCRIPTS}")
file(READ "${DIR}/page.html" page HEX)
macro(put mark text) # in hexadecimal: to CMake, brackets and semicolons are no plain text
  string(HEX "${mark}" hex_mark)
  string(REPLACE "${hex_mark}" "${text}" page "${page}")
endmacro()
file(READ "${DIR}/page.css" css HEX)
foreach(script ${SCRIPTS})
  file(READ "${DIR}/${script}" text HEX)
  string(APPEND scripts "${text}")
endforeach()
put("{{page.css}}" "${css}")
put("{{scripts}}" "${scripts}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${page}")
file(WRITE "${OUT}" "#include \"apps/view/view_server.h\"\n\nnamespace jaywalk::view {\nnamespace {\nconstexpr char kPage[] = {${bytes}};\n}\n"
  "std::string_view live_page() noexcept { return {kPage, sizeof kPage}; }\n}  // namespace jaywalk::view\n")
