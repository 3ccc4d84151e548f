mod tip;
