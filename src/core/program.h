/**
 * @file program.h
 * How a program is called where others are told of it.
 */
#ifndef CM1E_CORE_PROGRAM_H
#define CM1E_CORE_PROGRAM_H

#include <stddef.h>

/** This program with its first word that is no option: "cm1e move", "python3 machine.py". @rt init */
void cm1e_program_name(char *text, size_t size);
/** The path of its file, for a command that gives it a right; "<program>" if it is not known or too long. @rt block */
void cm1e_program_path(char *path, size_t size);
/** How this program gets the privileges for raw sockets, real-time priority and locked memory: a sentence without its
 *  point. In a container or service that lacks one, not even root has it, and a file with that capability does not
 *  start at all. @rt block */
void cm1e_program_cure(char *text, size_t size);

#endif
