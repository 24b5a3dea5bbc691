/* Stands in for the header of this name of MATIEC, whose macros the stand-in for iec2c does not use. */
