# cmake --install: the program, the headers, the models, the behaviors and find_package(kadans).
