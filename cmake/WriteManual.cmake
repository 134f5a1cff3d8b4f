# cmake -D KITH=<program> -D OUTPUT_DIR=<folder> [-D HTML_DIR=<folder>] -P WriteManual.cmake
#
# The man pages (kith.1 and one per command), from what the program says of itself, so that they can forget no command
# and no option. With HTML_DIR also web pages, index.html and one per command.
function(ask out)
  execute_process(COMMAND ${KITH} ${ARGN} OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

# As it is, for troff: neither macros nor escapes.
function(verbatim out text)
  string(REPLACE "\\" "\\e" text "${text}")
  string(REPLACE "-" "\\-" text "${text}")
  string(REGEX REPLACE "(^|\n)([.'])" "\\1\\\\&\\2" text "${text}")
  set(${out} ".nf\n${text}.fi\n" PARENT_SCOPE)
endfunction()

function(write_html name text)
  if(HTML_DIR)
    file(WRITE ${HTML_DIR}/${name}.html "<!doctype html>
<html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\"><title>kith ${name}</title>
<link rel=\"stylesheet\" href=\"../_static/alabaster.css\"><link rel=\"stylesheet\" href=\"../_static/site.css\">
<div class=\"body\"><p><a href=\"index.html\">Commands</a>, <a href=\"../docs/README.html\">documentation</a></p>
${text}</div></html>\n")
  endif()
endfunction()

ask(overview --help)
if(NOT overview MATCHES "commands:\n(([ ]+[a-z]+[^\n]*\n)+)")
  message(FATAL_ERROR "kith --help lists no commands")
endif()
string(REGEX MATCHALL "(^|\n)  [a-z]+" names "${CMAKE_MATCH_1}")

ask(version --version)
string(REGEX MATCH "[0-9]+\\.[0-9]+\\.[0-9]+" version "${version}")
verbatim(overview "${overview}")
set(page ".TH KITH 1 \"\" \"kith ${version}\" \"User Commands\"\n")
string(APPEND page ".SH NAME\nkith \\- teach a robot's policy to a group of people\n.SH DESCRIPTION\n${overview}")
foreach(name ${names})
  string(STRIP "${name}" name)
  ask(help help ${name})
  # "usage: ...", a blank line, the summary up to the next blank line, and the rest.
  if(NOT help MATCHES "^usage: ([^\n]*)\n\n(([^\n]+\n)+)\n(.*)$")
    message(FATAL_ERROR "kith help ${name} has no usage and summary")
  endif()
  set(usage "${CMAKE_MATCH_1}")
  set(summary "${CMAKE_MATCH_2}")
  set(rest "${CMAKE_MATCH_4}")
  string(REGEX REPLACE "[.]?\n+$" "" summary "${summary}")
  string(REPLACE "\n" " " summary "${summary}")
  string(REPLACE "&" "&amp;" html "${help}")
  string(REPLACE "<" "&lt;" html "${html}")
  write_html(${name} "<h1>kith ${name}</h1><pre>${html}</pre>")
  string(APPEND index "<li><a href=\"${name}.html\">kith ${name}</a>: ${summary}</li>\n")
  string(REPLACE "-" "\\-" summary "${summary}")
  verbatim(usage "${usage}\n")
  verbatim(rest "${rest}")
  string(TOUPPER ${name} heading)
  file(WRITE ${OUTPUT_DIR}/kith-${name}.1 ".TH KITH\\-${heading} 1 \"\" \"kith ${version}\" \"User Commands\"
.SH NAME
kith\\-${name} \\- ${summary}
.SH SYNOPSIS
${usage}.SH DESCRIPTION
${rest}.SH SEE ALSO
.BR kith (1)
")
  list(APPEND see_also ".BR kith\\-${name} (1)")
endforeach()
write_html(index "<h1>Commands</h1><ul>${index}</ul>")
list(JOIN see_also "\n" see_also)
file(WRITE ${OUTPUT_DIR}/kith.1 "${page}.SH SEE ALSO\n${see_also}\n")
