"""Where the histories of a run come from: a ride of the vehicle, a command of the user, files that are there."""
