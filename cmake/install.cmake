# cmake --install: headers, libraries and the package that find_package(Continuo) reads.
