"""Natural water: a surface with waves, what is seen through it and in it, and what light does below it."""
