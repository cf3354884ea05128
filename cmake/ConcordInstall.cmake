# Install rules and the exported CMake package (find_package(Concord)).
