# Writes a source that gives the program a hash of the code that computes its runs, from the contents of
# -DFILES=a,b,... (a list with commas), into -DOUT=...; rewrites it only when the hash has changed.
string(REPLACE "," ";" files "${FILES}")
set(hashes "")
foreach(file ${files})
  file(SHA256 ${file} hash)
  string(APPEND hashes ${hash})
endforeach()
string(SHA256 hash "${hashes}")
file(CONFIGURE OUTPUT ${OUT} CONTENT "#include \"studies/driver/code_hash.hpp\"
namespace {
const concord::studies::LinkedCode code(\"${hash}\");
}
")
