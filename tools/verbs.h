// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs of the program. Each is given its own argv (argv[0] is the verb's name) and returns the
// exit code: 0 good, 2 the user's input, 3 numerical failure, 4 system. Data go to stdout, messages
// to stderr.
#ifndef VSC_TOOLS_VERBS_H
#define VSC_TOOLS_VERBS_H

int vsc_verb_run(int argc, char **argv);
int vsc_verb_check(int argc, char **argv);
int vsc_verb_info(int argc, char **argv);
int vsc_verb_compare(int argc, char **argv);
int vsc_verb_measure(int argc, char **argv);
int vsc_verb_schema(int argc, char **argv);
int vsc_verb_generate(int argc, char **argv);
int vsc_verb_bench(int argc, char **argv);
int vsc_verb_calibrate(int argc, char **argv);

#endif
