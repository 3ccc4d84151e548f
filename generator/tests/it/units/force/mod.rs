mod branches;
